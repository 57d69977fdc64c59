// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <vector>

#include "detail/candidates.hpp"
#include "detail/chord_sides.hpp"
#include "detail/chord_tracer.hpp"
#include "placement_checks.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;

/// Lines that wind round the torus golden ratio times while they run around it once: never twice the same way.
OrientationField helices(const SurfaceMesh& mesh) {
  return field_of(mesh, [](const Vector& c, const Vector& normal) -> Vector {
    const Vector around(-c.y(), c.x(), 0);
    return around + std::numbers::phi * 0.7 * normal.cross(around).normalized();
  });
}

PlacementOptions with(double separation) {
  PlacementOptions options;
  options.separation_distance = separation;
  return options;
}

}  // namespace

TEST_CASE("long lines: they are even and complete, whatever candidates are left out beside them") {
  const auto mesh = torus(100, 40).mesh();
  const auto field = helices(mesh);
  for (const double separation : {0.15, 0.3}) {
    const auto placement = checked(mesh, field, with(separation));
    std::int64_t most = 0;  // chords of a line
    for (std::size_t i = 0; i < placement.lengths.size(); ++i) {
      most = std::max(most, placement.offsets[i + 1] - placement.offsets[i] - 1);
    }
    CHECK(most > 1024);
    check_segment_separation(placement, separation);
    check_self_separation(placement, separation);
    check_complete(mesh, field, placement, 10);
  }
}

TEST_CASE("long lines: parallel ones lie as close as they may, on both sides of each") {
  const auto mesh = grid(600, 12).mesh();
  const auto field = constant_field(mesh, Vector(1, 0, 0));
  for (const double separation : {0.3, 0.6, 1.0, 1.5, 3.0}) {
    const auto& statistics = place_streamlines(mesh, field, with(separation)).statistics;
    CHECK(statistics.mean_length == doctest::Approx(600).epsilon(1e-9));
    CHECK(statistics.mean_spacing <= 1.005 * separation);
  }
}

TEST_CASE("long lines: separation distances that are all the same are one") {
  const auto mesh = torus(200, 80).mesh();
  const auto field = helices(mesh);
  auto options = with(0.3);
  const auto same = place_streamlines(mesh, field, options);
  options.separation_distances.assign(mesh.triangle_count(), 0.3);
  CHECK(same_bytes(same, place_streamlines(mesh, field, options)));
}

TEST_CASE("long lines: what a spiral leaves of itself is no nearer to itself than the rest") {
  const auto mesh = jittered_grid(60, 60).mesh();
  for (const double slope : {0.01, 0.03, 0.06}) {
    const auto field = field_of(mesh, [&](const Vector& c, const Vector&) -> Vector {
      const Vector out(c.x() - 30.1, c.y() - 29.8, 0);
      return Vector(-out.y(), out.x(), 0) + slope * out;
    });
    for (const double separation : {2.5, 4.0, 7.0}) {
      const auto placement = checked(mesh, field, with(separation));
      check_segment_separation(placement, separation);
      check_self_separation(placement, separation);
      check_complete(mesh, field, placement, 10);
    }
  }
}

TEST_CASE("long lines: what comes far ends where it has come back to itself") {
  const auto mesh = torus(200, 80).mesh();
  const auto field = helices(mesh);
  for (const double separation : {0.3, 0.5}) {
    const StreamlineTracer tracer(mesh, field, {separation});
    const detail::ChordOccupancy occupancy(mesh, tracer, {});
    detail::ChordTracer chord_tracer(tracer, occupancy, {});
    detail::Chords chords;
    const auto ends = chord_tracer.trace({0, 0.5}, {}, chords);
    CHECK((ends[0] == StopReason::near_itself && ends[1] == StopReason::near_itself));

    std::vector<Vector> points;
    const auto& sheet = tracer.sheet();
    detail::visit_points(sheet, chords, false, [&](const Vector& point) { points.push_back(point); });
    std::vector<double> arc{0};
    for (std::size_t i = 1; i < points.size(); ++i) arc.push_back(arc.back() + (points[i] - points[i - 1]).norm());
    // If the first or the last point comes near another, then because of criterion 5.
    for (const auto end : {std::size_t{0}, points.size() - 1}) {
      double least = separation;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (std::abs(arc[i] - arc[end]) > 2 * separation) least = std::min(least, (points[i] - points[end]).norm());
      }
      CHECK(least < separation);
    }
    // Lines d_sep apart would be as long as area / d_sep.
    CHECK(arc.back() < 2 * mesh.area() / separation);
    CHECK(arc.back() > 64 * separation);
  }
}

TEST_CASE("long lines: a trajectory is left off where it has come far through served triangles, and only there") {
  const auto mesh = grid(1000, 4).mesh();
  const auto field = constant_field(mesh, Vector(1, 0.0003, 0));
  const StreamlineTracer tracer(mesh, field, {0.5});
  const auto& sheet = tracer.sheet();
  const detail::ChordOccupancy occupancy(mesh, tracer, {});
  detail::ChordTracer chord_tracer(tracer, occupancy, {});
  const auto column_of = [&](std::int32_t t) { return sheet.low(t).x(); };
  const auto middle = *std::ranges::min_element(
      sheet.ranks, {}, [&](std::int32_t t) { return (sheet.low(t) - Vector(500, 2, 0)).norm(); });
  const auto trace_served = [&](const auto& is_served) {
    detail::TriangleMarks served(mesh.triangle_count());
    for (std::int32_t t = 0; t < sheet.triangle_count(); ++t) {
      if (is_served(column_of(t))) served.add(t);
    }
    detail::Chords chords;
    const auto ends = chord_tracer.trace({middle, 0.5}, {false, &served}, chords);
    const auto columns = std::minmax({column_of(chords.front().triangle()), column_of(chords.back().triangle())});
    return std::tuple(ends, static_cast<int>(columns.first), static_cast<int>(columns.second));
  };
  constexpr auto border = StopReason::boundary;
  using Ends = std::array<StopReason, 2>;
  // Two chords a column.
  const auto [none, none_low, none_high] = trace_served([](double) { return false; });
  CHECK(none == Ends{border, border});
  CHECK((none_low <= 1 && none_high >= 998));
  const auto [all, all_low, all_high] = trace_served([](double) { return true; });
  CHECK(all == Ends{detail::left_off, detail::left_off});
  CHECK((all_low <= 500 - 128 && all_low >= 500 - 128 - 12 && all_high >= 500 + 128 && all_high <= 500 + 128 + 12));
  const auto [short_runs, short_low, short_high] =
      trace_served([](double x) { return static_cast<int>(x) % 125 < 120; });
  CHECK(short_runs == Ends{border, border});
  const auto [one, one_low, one_high] = trace_served([](double x) { return x > 600; });
  CHECK((std::ranges::count(one, border) == 1 && std::ranges::count(one, detail::left_off) == 1));
  CHECK((one_low <= 1 && one_high >= 600 + 128 && one_high <= 600 + 128 + 12));
}

TEST_CASE("long lines: what was left off runs on to its natural ends when it is placed") {
  const auto mesh = jittered_grid(900, 14).mesh();
  auto roomy = with(0.7), polished = with(0.8);
  roomy.seed_clearance = 1.3;
  polished.polishing_rounds = 5;
  for (const double slope : {0.02, 0.1}) {
    const auto field = field_of(mesh, [&](const Vector& c, const Vector&) -> Vector {
      return Vector(1, slope * std::sin(c.x() / 90 + c.y() / 5), 0);
    });
    for (auto options : {with(0.5), with(0.9), roomy, polished}) {
      const double separation = options.separation_distance;
      const auto placement = checked(mesh, field, options);
      // Nothing ends but at the border or beside another.
      for (const auto& ends : placement.stop_reasons) {
        for (const auto reason : ends) CHECK((reason == StopReason::boundary || reason == StopReason::near_other));
      }
      check_segment_separation(placement, separation);
      if (options.seed_clearance == 1) check_complete(mesh, field, placement, 10);
    }
  }
}

TEST_CASE("long lines: what was left off may be longer than it is, also than the minimum length") {
  for (const auto end : {StopReason::boundary, detail::left_off}) {
    detail::Candidates candidates(100, 3, {1, 1});
    auto& chords = candidates.chords();
    chords.assign(4, {0.5, 0.5F, 0});  // of length 2
    candidates.add({{0, 4}, {StopReason::boundary, end}, false});
    const bool is_left_off = end == detail::left_off;
    REQUIRE(candidates.piece_count() == (is_left_off ? 1 : 0));
    if (is_left_off) candidates.pop();
    CHECK(candidates.is_first({1, 4}, 1.5, 0) == is_left_off);
    CHECK(!candidates.is_first({0, 3}, 1.5, 0));  // without that end
    candidates.push({0, 3}, 1.5, 0);
    CHECK(candidates.piece_count() == 0);
  }
}

}  // namespace pectinate::test
