// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "pectinate/occupancy.hpp"
#include "placement_checks.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;

/// A surface, its exact occupancy and the lines that were added to it.
struct Bench {
  Bench(const Soup& soup, const TracingOptions& options, std::uint64_t field_seed, const Clearance& clearance = {})
      : Bench(
            soup, options,
            [=](const SurfaceMesh& m) { return field_seed == 0 ? smooth_field(m) : random_field(m, field_seed); },
            clearance) {}

  Bench(const Soup& soup, const TracingOptions& options,
        const std::function<OrientationField(const SurfaceMesh&)>& make_field, const Clearance& clearance = {})
      : mesh(soup.mesh()),
        field(make_field(mesh)),
        tracer(mesh, field, options),
        occupancy(make_exact_occupancy(mesh, tracer, clearance)) {}

  /// Adds the line through a seed, criterion 3 off.
  void add(const EdgePoint& seed) {
    if (!tracer.start_triangle(seed.edge)) return;
    const auto workspace = StreamlineTracer::make_workspace();
    const auto& line = tracer.trace(seed, nullptr, *workspace);
    if (line.triangles.empty()) return;
    occupancy->add(line);
    const auto at = places(mesh, line);
    for (std::size_t i = 0; i < line.triangles.size(); ++i) {
      segments.push_back({at[i], at[i + 1], 0, 0, 0, tracer.separation_distance(line.triangles[i])});
    }
  }

  void add_random(Random& random) {
    const auto edge = static_cast<std::int32_t>(random.below(mesh.edges().size()));
    add({edge, random.unit()});
  }

  /// The room that a chord has beside the lines, by a measure of one chord and one segment; infinite if it is plenty.
  template <class Measure>
  double least_room(std::int32_t triangle, double chord, const Measure& measure) const {
    const auto piece = chord_segment(tracer.sheet(), triangle, chord);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& segment : segments) {
      if (!piece.is_farther_than(segment, 2 * segment.separation_distance)) {
        least = std::min(least, measure(piece, segment));
      }
    }
    return least;
  }

  const detail::TriangleCrossings& crossings(std::int32_t triangle) const {
    return tracer.sheet().crossings[tracer.sheet().ranks[triangle]];
  }

  bool admits(std::int32_t triangle, double chord) const {
    return occupancy->admits(triangle, chord,
                             detail::edge_point(mesh, triangle, crossings(triangle), detail::low_high, chord));
  }

  bool admits_seed(std::int32_t triangle, double chord) const {
    return occupancy->admits_seed(
        {detail::edge_point(mesh, triangle, crossings(triangle), detail::low_high, chord), triangle});
  }

  double greatest_separation() const {
    double greatest = 0;
    for (const auto& segment : segments) greatest = std::max(greatest, segment.separation_distance);
    return greatest;
  }

  std::int32_t triangle_count() const { return static_cast<std::int32_t>(mesh.triangle_count()); }

  SurfaceMesh mesh;
  OrientationField field;
  StreamlineTracer tracer;
  std::unique_ptr<Occupancy> occupancy;
  std::vector<Piece> segments;
};

constexpr int chords_per_triangle = 40;

double sample(int i) {
  return (i + 0.5) / chords_per_triangle;
}

/// More than the guards of the engine take, in separation distances, of a capsule and across the chords.
constexpr double guard = 3e-6;

/// Is a chord that is taken, but for the guard, the last one that lacks room?
template <class Room>
void check_border(const Bench& bench, const Room& room, std::int32_t t, double free, double taken) {
  CHECK(room(t, free) >= 1);
  const double shift = std::copysign(guard * bench.greatest_separation() / bench.crossings(t).width, taken - free);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 1; i <= 8; ++i) least = std::min(least, room(t, std::clamp(free + i * shift / 8, 0.0, 1.0)));
  CHECK(least <= 1 + guard);
}

/// What is admitted has room, what has more is admitted, and so it is right at the border.
template <class Room, class Admits>
void check_chords(const Bench& bench, const Room& room, const Admits& admits) {
  for (std::int32_t t = 0; t < bench.triangle_count(); ++t) {
    if (!bench.field.has_direction(t)) {
      CHECK(!admits(t, 0.5));
      continue;
    }
    for (int i = 0; i < chords_per_triangle; ++i) {
      const double at_sample = room(t, sample(i));
      const bool admitted = admits(t, sample(i));
      if (admitted) CHECK(at_sample >= 1);
      if (at_sample > 1.001) CHECK(admitted);
      if (i == 0 || admits(t, sample(i - 1)) == admitted) continue;
      double free = sample(admitted ? i : i - 1), taken = sample(admitted ? i - 1 : i);
      for (int step = 0; step < 50; ++step) {
        const double middle = (free + taken) / 2;
        (admits(t, middle) ? free : taken) = middle;
      }
      check_border(bench, room, t, free, taken);
    }
  }
}

void check_exact(const Bench& bench, const Clearance& clearance = {}) {
  const auto room_to_go_on = [&](std::int32_t t, double chord) {
    return bench.least_room(t, chord,
                            [&](const Piece& piece, const Piece& line) { return room(piece, line, clearance.stop); });
  };
  const auto room_to_start = [&](std::int32_t t, double chord) {
    return bench.least_room(t, chord,
                            [&](const Piece& piece, const Piece& line) { return seed_room(piece, line, clearance); });
  };
  check_chords(bench, room_to_go_on, [&](std::int32_t t, double chord) { return bench.admits(t, chord); });
  check_chords(bench, room_to_start, [&](std::int32_t t, double chord) { return bench.admits_seed(t, chord); });
}

/// The share of the area of all triangles with a direction whose chords are refused, by counting chords.
double counted_coverage(const Bench& bench) {
  double taken = 0, total = 0;
  for (std::int32_t t = 0; t < bench.triangle_count(); ++t) {
    if (!bench.field.has_direction(t)) continue;
    for (int i = 0; i < chords_per_triangle; ++i) {
      const double weight = bench.mesh.triangle_areas()[t] * detail::chord_length(bench.crossings(t), sample(i)) /
                            bench.crossings(t).longest_chord;
      taken += bench.admits(t, sample(i)) ? 0 : weight;
      total += weight;
    }
  }
  return taken / total;
}

std::int32_t refused_count(const Bench& bench, std::int32_t triangle) {
  std::int32_t count = 0;
  for (int i = 0; i < chords_per_triangle; ++i) count += !bench.admits(triangle, sample(i));
  return count;
}

std::vector<double> random_separations(std::size_t count, double least, double most) {
  Random random(count);
  std::vector<double> separations(count);
  for (auto& separation : separations) separation = least + (most - least) * random.unit();
  return separations;
}

}  // namespace

TEST_CASE("exact occupancy: on flat surfaces it is what the distances to all segments say") {
  Random random(1);
  for (const std::uint64_t field_seed : {0, 1, 2, 3}) {
    for (const double separation : {0.02, 0.2, 0.9, 2.5, 8.0}) {
      CAPTURE(separation);
      CAPTURE(field_seed);
      Bench bench(jittered_grid(14, 10, 1, 10 + field_seed), {separation}, field_seed);
      CHECK(bench.occupancy->coverage() == 0);
      for (int round = 0; round < 3; ++round) bench.add_random(random);
      REQUIRE(!bench.segments.empty());
      check_exact(bench);
      CHECK(std::abs(bench.occupancy->coverage() - counted_coverage(bench)) < 0.01);
    }
  }
}

TEST_CASE("exact occupancy: on curved surfaces too") {
  Random random(2);
  const auto rotated = [](const Soup& soup) {
    return mapped(soup, [](const Vector& v) { return Vector(some_rotation() * v + Vector(7, -3, 2)); });
  };
  for (const std::uint64_t field_seed : {0, 5}) {
    for (const double share : {0.2, 1.0, 3.0}) {
      CAPTURE(share);
      CAPTURE(field_seed);
      // Edges of about 0.13, 0.25 and 0.1: never so far that space is crossed.
      for (const auto& [soup, edge] : {std::pair{sphere(3), 0.15},
                                       {torus(50, 18), 0.25},
                                       {cylinder(30, 14, 1, 3), 0.2},
                                       {moebius_strip(60, 6), 0.16}}) {
        Bench bench(rotated(soup), {share * edge}, field_seed);
        for (int round = 0; round < 3; ++round) bench.add_random(random);
        check_exact(bench);
      }
    }
  }
}

TEST_CASE("exact occupancy: of meshes with thin, long and unequal triangles") {
  Random random(3);
  const auto squeezed = [](double factor) {
    return mapped(jittered_grid(14, 10), [=](const Vector& v) { return Vector(v.x(), factor * v.y(), 0); });
  };
  const auto graded =
      mapped(jittered_grid(20, 10), [](const Vector& v) { return Vector(0.05 * v.x() * v.x(), v.y(), 0); });
  for (const double separation : {0.1, 0.7, 3.0}) {
    for (const auto& soup : {squeezed(0.1), squeezed(0.003), squeezed(20), graded}) {
      Bench bench(soup, {separation}, 0);
      for (int round = 0; round < 2; ++round) bench.add_random(random);
      check_exact(bench);
    }
  }
}

TEST_CASE("exact occupancy: the clearances for seeds and for stops are apart") {
  Random random(4);
  for (const auto& clearance : {Clearance{1, 1.16}, Clearance{0.8, 1}, Clearance{0.5, 1.9}, Clearance{0.7, 0.7}}) {
    for (const double separation : {0.3, 1.5}) {
      Bench bench(jittered_grid(14, 10), {separation}, 0, clearance);
      for (int round = 0; round < 2; ++round) bench.add_random(random);
      check_exact(bench, clearance);
      CHECK(std::abs(bench.occupancy->coverage() - counted_coverage(bench)) < 0.01);
    }
  }
}

TEST_CASE("exact occupancy: the separation distance is that where the placed line lies") {
  Random random(5);
  const auto soup = jittered_grid(14, 10);
  for (const auto& [least, most] : {std::pair{0.1, 0.4}, {0.2, 3.0}, {2.0, 6.0}}) {
    for (const std::uint64_t field_seed : {0, 3}) {
      Bench bench(soup, {1, random_separations(soup.triangles.size(), least, most)}, field_seed);
      for (int round = 0; round < 3; ++round) bench.add_random(random);
      check_exact(bench);
    }
  }
}

TEST_CASE("exact occupancy: triangles without a direction are refused, and crossed by distances") {
  Random random(6);
  const auto with_holes = [](const SurfaceMesh& mesh) {
    return field_of(mesh, [](const Vector& c, const Vector&) {
      const bool hole = std::abs(std::fmod(c.x(), 4) - 2) < 0.7;
      return hole ? Vector(0, 0, 0) : Vector(0.2 + 0.1 * c.x(), 1, 0);
    });
  };
  for (const double separation : {0.4, 2.5}) {
    Bench bench(jittered_grid(14, 10), {separation}, with_holes);
    for (int round = 0; round < 3; ++round) bench.add_random(random);
    REQUIRE(bench.field.count(DirectionStatus::zero) > 10);
    check_exact(bench);
    CHECK(std::abs(bench.occupancy->coverage() - counted_coverage(bench)) < 0.01);
  }
}

TEST_CASE("exact occupancy: adding only ever adds") {
  Bench bench(jittered_grid(9, 8), {0.4}, 3, {1, 1.2});
  Random random(4);
  std::vector<bool> stopped(bench.triangle_count() * chords_per_triangle), unseeded = stopped;
  double coverage = 0;
  for (int round = 0; round < 8; ++round) {
    bench.add_random(random);
    for (std::int32_t t = 0; t < bench.triangle_count(); ++t) {
      for (int i = 0; i < chords_per_triangle; ++i) {
        const auto index = t * chords_per_triangle + i;
        const bool stops = !bench.admits(t, sample(i)), takes_seeds = !bench.admits_seed(t, sample(i));
        CHECK((stops || !stopped[index]));
        CHECK((takes_seeds || !unseeded[index]));
        CHECK((takes_seeds || !stops));
        stopped[index] = stops;
        unseeded[index] = takes_seeds;
      }
    }
    CHECK(bench.occupancy->coverage() >= coverage);
    coverage = bench.occupancy->coverage();
  }
  CHECK(coverage > 0.2);
}

TEST_CASE("exact occupancy: another sheet that is near in space only stays free") {
  Bench bench(together(jittered_grid(9, 8), moved(jittered_grid(9, 8), {0, 0, 0.1})), {0.5}, 0);
  bench.add({bench.mesh.triangle_edges()[60][0], 0.5});
  int below = 0, above = 0;
  for (std::int32_t t = 0; t < bench.triangle_count(); ++t) {
    (centre(bench.mesh, t).z() > 0.05 ? above : below) += refused_count(bench, t);
  }
  CHECK(above == 0);
  CHECK(below > 0);
}

TEST_CASE("exact occupancy: two sides of a fold are far from each other along the surface") {
  const auto strip = mapped(jittered_grid(20, 4, 0.5),
                            [](const Vector& v) { return v.x() <= 5 ? v : Vector(10 - v.x() + 0.2, v.y(), 0.2); });
  Bench bench(strip, {0.4}, [](const SurfaceMesh& mesh) { return constant_field(mesh, Vector(0.02, 1, 0)); });
  bench.add({bench.mesh.triangle_edges()[8][0], 0.5});
  for (std::int32_t t = 0; t < bench.triangle_count(); ++t) {
    if (centre(bench.mesh, t).z() > 0.1) CHECK(refused_count(bench, t) == 0);
  }
  CHECK(bench.occupancy->coverage() > 0.02);
}

TEST_CASE("exact occupancy: a slit that ends within an edge of the band does not part its sides") {
  // Two columns of squares, joined from y = 9 upwards only; their other sides coincide. A segment across the left one
  // at y = 8.2 is 0.8 from there.
  Soup soup = grid(2, 10);
  for (int j = 0; j < 9; ++j) soup.vertices.push_back(soup.vertices[1 + 3 * j]);
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    for (auto& v : soup.triangles[t]) {
      if (t % 4 >= 2 && v % 3 == 1 && v < 27) v = 33 + v / 3;
    }
  }
  for (const double separation : {0.7, 0.9}) {
    Bench bench(soup, {separation}, [](const SurfaceMesh& mesh) { return constant_field(mesh, Vector(1, 1e-3, 0)); });
    const auto left_border = bench.mesh.triangle_edges()[4 * 8 + 1][2];  // from (0, 8) to (0, 9)
    bench.add({left_border, bench.mesh.runs_along(4 * 8 + 1, 2) ? 0.8 : 0.2});
    REQUIRE(bench.segments.size() == 2);
    check_exact(bench);
  }
}

TEST_CASE("exact occupancy: a jagged border does not cut the search off") {
  // Without some of the triangles that have a side on the border, their neighbours are teeth of a saw.
  Random random(8);
  for (int round = 0; round < 12; ++round) {
    Soup soup = jittered_grid(12, 9, 1, 20 + round);
    std::vector<Triangle> kept;
    for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
      const bool at_bottom = t < 24 && t % 2 == 0, at_top = t >= 24 * 8 && t % 2 == 1;
      if (!((at_bottom || at_top) && random.below(3) > 0)) kept.push_back(soup.triangles[t]);
    }
    soup.triangles = kept;
    Bench bench(soup, {0.3 + 1.5 * random.unit()}, round % 3);
    for (int line = 0; line < 4; ++line) bench.add_random(random);
    check_exact(bench);
  }
}

TEST_CASE("exact occupancy: the search crosses a cut, where surfaces touch") {
  Bench bench(three_on_an_edge(), {0.3},
              [](const SurfaceMesh& mesh) { return constant_field(mesh, Vector(0.3, 0.2, 1)); });
  const auto shared = bench.mesh.triangle_edges()[0][0];
  REQUIRE(bench.mesh.edge_triangles(shared).size() == 3);
  bench.add({shared, 0.5});
  for (std::int32_t t = 0; t < 3; ++t) CHECK(refused_count(bench, t) > 0);
  check_exact(bench);
}

TEST_CASE("exact occupancy: the search goes on from shell to shell where closed ones share an edge") {
  // Two tetrahedra, 0 1 2 3 and 0 1 4 5: at the edge from 0 to 1 each is joined with itself.
  const Soup shells{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}},
                    {{0, 1, 2}, {1, 0, 3}, {0, 2, 3}, {1, 3, 2}, {0, 1, 4}, {1, 0, 5}, {0, 4, 5}, {1, 5, 4}}};
  Bench bench(shells, {0.2}, [](const SurfaceMesh& mesh) { return constant_field(mesh, Vector(0.3, 0.2, 1)); });
  REQUIRE(bench.mesh.boundary_loops().empty());
  std::vector<std::int32_t> at_edge;
  for (std::int32_t e = 0; e < static_cast<std::int32_t>(bench.mesh.edges().size()); ++e) {
    const auto around = bench.mesh.edge_triangles(e);
    if (around.size() != 4) continue;
    at_edge.assign(around.begin(), around.end());
    bench.add({e, 0.5});
  }
  REQUIRE(at_edge.size() == 4);
  for (const auto t : at_edge) CHECK(refused_count(bench, t) > 0);
  check_exact(bench);
}

TEST_CASE("exact occupancy: seeds are drawn evenly by area from what is free") {
  Bench bench(jittered_grid(6, 5), {0.35}, 0);
  bench.add({bench.mesh.triangle_edges()[25][1], 0.5});
  Random random(8);
  for (const auto region : {SeedRegion::free, SeedRegion::partly_free, SeedRegion::wholly_free}) {
    const int pieces = 2000;
    std::vector<double> weights(bench.triangle_count(), 0);
    double total = 0;
    for (std::int32_t t = 0; t < bench.triangle_count(); ++t) {
      double free = 0, all = 0;
      for (int i = 0; i < pieces; ++i) {
        const double chord = (i + 0.5) / pieces, length = detail::chord_length(bench.crossings(t), chord);
        all += length;
        free += bench.admits(t, chord) ? length : 0;
      }
      const bool counts = region == SeedRegion::free || (region == SeedRegion::wholly_free) == (free == all);
      weights[t] = counts ? free / all * bench.mesh.triangle_areas()[t] : 0;
      total += weights[t];
    }
    const int draws = 40000;
    std::vector<int> counts(bench.triangle_count(), 0);
    for (int i = 0; i < draws; ++i) {
      const auto seed = bench.occupancy->draw_seed(region, random);
      REQUIRE(seed.has_value());
      CHECK(bench.occupancy->admits_seed(*seed));
      CHECK(has_edge(bench.mesh, seed->triangle, seed->point.edge));
      ++counts[seed->triangle];
    }
    double chi_square = 0;
    int freedom = -1;
    for (std::int32_t t = 0; t < bench.triangle_count(); ++t) {
      const double expected = draws * weights[t] / total;
      if (expected == 0) CHECK(counts[t] == 0);
      if (expected < 5) continue;
      chi_square += (counts[t] - expected) * (counts[t] - expected) / expected;
      ++freedom;
    }
    REQUIRE(freedom > 3);
    CHECK(chi_square < freedom + 5 * std::sqrt(2.0 * freedom));
  }
}

TEST_CASE("exact occupancy: a retired seed is not drawn again, but can be crossed and is not covered") {
  for (const auto& clearance : {Clearance{1, 1}, Clearance{1, 1.2}}) {
    Bench bench(one_triangle(), {0.1}, 0, clearance);
    Random random(9);
    int count = 0;
    while (const auto seed = bench.occupancy->draw_seed(SeedRegion::free, random)) {
      REQUIRE(++count < 200);
      CHECK(bench.occupancy->admits_seed(*seed));
      bench.occupancy->retire_seed(*seed);
      CHECK(!bench.occupancy->admits_seed(*seed));
    }
    CHECK(count > 30);
    CHECK(refused_count(bench, 0) == 0);
    CHECK(bench.occupancy->coverage() == 0);
  }
}

TEST_CASE("exact occupancy: a line that covers all leaves nothing to draw") {
  Bench bench(jittered_grid(4, 3), {100}, 0);
  bench.add({0, 0.5});
  CHECK(bench.occupancy->coverage() == 1);
  Random random(1);
  CHECK(bench.occupancy->draw_seed(SeedRegion::free, random) == std::nullopt);
}

}  // namespace pectinate::test
