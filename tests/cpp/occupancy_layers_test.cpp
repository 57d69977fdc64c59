// SPDX-License-Identifier: MIT
#include "detail/occupancy_layers.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "lines.hpp"

namespace pectinate::test {
namespace {

using detail::ChordOccupancy;
using detail::Interval;
using detail::IntervalSets;
using detail::Polyline;

/// The line through a random seed that nothing hinders.
Polyline random_line(const SurfaceMesh& mesh, const StreamlineTracer& tracer, Random& random) {
  const auto workspace = StreamlineTracer::make_workspace();
  const auto& sheet = tracer.sheet();
  while (true) {
    const EdgePoint seed{static_cast<std::int32_t>(random.below(mesh.edges().size())), random.unit()};
    if (!tracer.start_triangle(seed.edge)) continue;
    const auto& line = tracer.trace(seed, nullptr, *workspace);
    if (line.triangles.empty()) continue;
    Polyline polyline;
    for (const auto& point : line.points) polyline.points.push_back(detail::position(mesh, point));
    for (std::size_t i = 0; i < line.triangles.size(); ++i) {
      const auto t = sheet.ranks[line.triangles[i]];
      const auto role = detail::role_with_edge(mesh, line.triangles[i], sheet.crossings[t], line.points[i].edge);
      polyline.triangles.push_back(t);
      polyline.chords.push_back(detail::chord_coordinate(sheet.crossings[t], role, line.points[i].position));
    }
    return polyline;
  }
}

bool same_sets(const IntervalSets& a, const IntervalSets& b, std::int32_t count) {
  for (std::int32_t t = 0; t < count; ++t) {
    const auto first = a.intervals(t), second = b.intervals(t);
    const bool same = std::ranges::equal(
        first, second, [](const Interval& x, const Interval& y) { return x.low == y.low && x.high == y.high; });
    if (!same || a.is_full(t) != b.is_full(t)) return false;
    for (int i = 0; i <= 32; ++i) {
      if (a.contains(t, i / 32.0) != b.contains(t, i / 32.0)) return false;
    }
  }
  return true;
}

struct Bench {
  const SurfaceMesh& mesh;
  const StreamlineTracer& tracer;
  Clearance clearance;
  SingularRegion singular;

  ChordOccupancy occupancy() const { return ChordOccupancy(mesh, tracer, clearance, singular); }
  /// What the lines mark that are left, marked afresh.
  bool is_as_fresh(const ChordOccupancy& occupancy, const std::vector<Polyline>& lines,
                   const std::vector<bool>& is_out) const {
    auto fresh = this->occupancy();
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (!is_out[i]) fresh.add(lines[i]);
    }
    const auto count = static_cast<std::int32_t>(mesh.triangle_count());
    return same_sets(occupancy.stopped(), fresh.stopped(), count) &&
           same_sets(occupancy.unseeded(), fresh.unseeded(), count) && occupancy.coverage() == fresh.coverage();
  }
};

/// Lines are taken back and put back at random.
void check_layers(const Bench& bench, std::uint64_t seed) {
  Random random(seed);
  auto occupancy = bench.occupancy();
  detail::OccupancyLayers layers(bench.mesh, bench.tracer, occupancy);
  std::vector<Polyline> lines;
  for (std::int32_t i = 0; i < 12; ++i) {
    lines.push_back(random_line(bench.mesh, bench.tracer, random));
    layers.add(i, lines.back());
  }
  std::vector<bool> is_out(lines.size(), false);
  CHECK(bench.is_as_fresh(occupancy, lines, is_out));
  for (int round = 0; round < 12; ++round) {
    std::vector<std::int32_t> taken, put;
    for (std::int32_t i = 0; i < std::ssize(lines); ++i) {
      if (random.unit() < 0.7) continue;
      (is_out[i] ? put : taken).push_back(i);
      is_out[i] = !is_out[i];
    }
    layers.take_back(taken);
    layers.put_back(put);
    if (!taken.empty() && random.unit() < 0.5) {  // a number is used again
      const auto line = taken[0];
      lines[line] = random_line(bench.mesh, bench.tracer, random);
      layers.add(line, lines[line]);
      is_out[line] = false;
    }
    CHECK(bench.is_as_fresh(occupancy, lines, is_out));
  }
}

}  // namespace

TEST_CASE("occupancy layers: what was taken back leaves what the other lines mark alone") {
  const auto flat = jittered_grid(16, 12).mesh(), curved = torus(24, 12).mesh();
  std::uint64_t seed = 1;
  for (const auto* mesh : {&flat, &curved}) {
    const auto field = smooth_field(*mesh);
    for (const double separation : {0.1, 0.6, 2.5}) {
      CAPTURE(separation);
      const StreamlineTracer tracer(*mesh, field, {separation});
      for (const Clearance clearance : {Clearance{1, 1}, Clearance{1, 1.2}, Clearance{0.8, 1}}) {
        check_layers({*mesh, tracer, clearance, {}}, ++seed);
        check_layers({*mesh, tracer, clearance, {{3, 40}, 0.7}}, ++seed);
      }
    }
  }
}

TEST_CASE("occupancy layers: with a varying separation distance and triangles without a direction") {
  const auto mesh = jittered_grid(16, 12).mesh();
  auto vectors = triangle_vectors(mesh, [](const auto&, const auto&) { return detail::Vector(1, 0.2, 0); });
  std::vector<double> separations;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    separations.push_back(0.2 + 0.05 * (t % 7));
    if (t % 50 < 3) vectors[t] = {0, 0, 0};
  }
  const auto field = OrientationField::from_triangle_vectors(mesh, vectors);
  const StreamlineTracer tracer(mesh, field, {1, separations});
  check_layers({mesh, tracer, {}, {}}, 5);
  check_layers({mesh, tracer, {1, 1.3}, {}}, 6);
}

TEST_CASE("occupancy layers: it is known who takes a chord") {
  const auto mesh = jittered_grid(16, 12).mesh();
  const auto field = smooth_field(mesh);
  const StreamlineTracer tracer(mesh, field, {0.8});
  ChordOccupancy occupancy(mesh, tracer, {});
  detail::OccupancyLayers layers(mesh, tracer, occupancy);
  Random random(3);
  std::vector<ChordOccupancy> alone;
  for (std::int32_t line = 0; line < 8; ++line) {
    const auto polyline = random_line(mesh, tracer, random);
    layers.add(line, polyline);
    alone.emplace_back(mesh, tracer, Clearance{});
    alone.back().add(polyline);
  }
  for (int i = 0; i < 2000; ++i) {
    const auto t = static_cast<std::int32_t>(random.below(mesh.triangle_count()));
    const double chord = random.unit();
    const auto takers = layers.takers(t, chord);
    for (std::int32_t line = 0; line < 8; ++line) {
      const bool takes = alone[line].stopped().contains(t, chord);
      CHECK((std::ranges::find(takers, line) != takers.end()) == takes);
      CHECK(layers.is_taken_by_other(line, t, chord) == (std::ssize(takers) > (takes ? 1 : 0)));
    }
  }
}

}  // namespace pectinate::test
