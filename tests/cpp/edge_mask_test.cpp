// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "lines.hpp"
#include "pectinate/occupancy.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;

constexpr int sub_segments = 64;

/// A surface, its mask and the lines that were added to it.
struct Bench {
  Bench(const Soup& soup, double separation, std::uint64_t field_seed)
      : separation_distance(separation),
        mesh(soup.mesh()),
        field(field_seed == 0 ? smooth_field(mesh) : random_field(mesh, field_seed)),
        tracer(mesh, field, {separation}),
        mask(make_edge_mask(mesh, tracer)) {}

  Streamline trace(const EdgePoint& seed, const Occupancy* occupancy) const {
    const auto workspace = StreamlineTracer::make_workspace();
    return tracer.trace(seed, occupancy, *workspace);
  }

  /// Adds the line through a seed, unless it has no segment; criterion 3 off.
  void add(const EdgePoint& seed) {
    const auto line = trace(seed, nullptr);
    if (line.triangles.empty()) return;
    mask->add(line);
    lines.push_back(places(mesh, line));
  }

  double distance(const Vector& point) const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& line : lines) least = std::min(least, distance_to_polyline(point, line));
    return least;
  }

  bool is_occupied(std::int32_t edge, int sub_segment) const {
    return !mask->admits(0, 0.5, {edge, (sub_segment + 0.5) / sub_segments});
  }

  int occupied_count(std::int32_t edge) const {
    int count = 0;
    for (int i = 0; i < sub_segments; ++i) count += is_occupied(edge, i);
    return count;
  }

  /// The least distance of some points of a sub-segment, its ends among them, from the lines.
  double distance_of(std::int32_t edge, int sub_segment) const {
    double least = std::numeric_limits<double>::infinity();
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      least = std::min(least, distance(detail::position(mesh, {edge, (sub_segment + share) / sub_segments})));
    }
    return least;
  }

  std::int32_t edge_count() const { return static_cast<std::int32_t>(mesh.edges().size()); }

  double separation_distance;
  SurfaceMesh mesh;
  OrientationField field;
  StreamlineTracer tracer;
  std::unique_ptr<Occupancy> mask;
  std::vector<std::vector<Vector>> lines;
};

EdgePoint random_point(const Bench& bench, Random& random) {
  return {static_cast<std::int32_t>(random.below(bench.mesh.edges().size())), random.unit()};
}

/// Free sub-segments are farther than d_sep from all lines, occupied ones come that near. The coverage is their share.
void check_exact(const Bench& bench) {
  double occupied = 0, total = 0;
  for (std::int32_t edge = 0; edge < bench.edge_count(); ++edge) {
    const double piece = bench.mesh.edge_lengths()[edge] / sub_segments;
    for (int i = 0; i < sub_segments; ++i) {
      const double distance = bench.distance_of(edge, i);
      const bool is_occupied = bench.is_occupied(edge, i);
      if (!is_occupied) CHECK(distance >= bench.separation_distance * (1 - 1e-12));
      // The nearest of five points is at most an eighth of the sub-segment from its nearest point.
      if (is_occupied) CHECK(distance <= bench.separation_distance + piece / 8 + 1e-12);
      occupied += is_occupied * piece;
      total += piece;
    }
  }
  CHECK(bench.mask->coverage() == doctest::Approx(occupied / total).epsilon(1e-3));
}

}  // namespace

TEST_CASE("edge mask: the mask is what the distances to all segments say") {
  Random random(1);
  for (const std::uint64_t field_seed : {0, 1, 2}) {
    for (const double separation : {0.02, 0.3, 0.9, 2.5}) {
      CAPTURE(separation);
      Bench bench(jittered_grid(8, 6), separation, field_seed);
      CHECK(bench.mask->coverage() == 0);
      for (int round = 0; round < 2; ++round) bench.add(random_point(bench, random));
      REQUIRE(!bench.lines.empty());
      check_exact(bench);
    }
  }
}

TEST_CASE("edge mask: on a sphere too, where lines pass through space") {
  Random random(2);
  for (const double separation : {0.05, 0.3}) {
    Bench bench(sphere(3), separation, 0);
    for (int round = 0; round < 3; ++round) bench.add(random_point(bench, random));
    check_exact(bench);
  }
}

TEST_CASE("edge mask: adding only ever adds") {
  Bench bench(jittered_grid(6, 5), 0.4, 3);
  Random random(4);
  std::vector<int> before(bench.edge_count(), 0);
  double coverage = 0;
  for (int round = 0; round < 8; ++round) {
    bench.add(random_point(bench, random));
    for (std::int32_t edge = 0; edge < bench.edge_count(); ++edge) {
      const int now = bench.occupied_count(edge);
      CHECK(now >= before[edge]);
      before[edge] = now;
    }
    CHECK(bench.mask->coverage() >= coverage);
    coverage = bench.mask->coverage();
  }
  CHECK(coverage > 0.3);
}

TEST_CASE("edge mask: another sheet that is near in space only stays free") {
  const double separation = 0.5;
  Bench bench(together(jittered_grid(6, 5), moved(jittered_grid(6, 5), {0, 0, 0.1})), separation, 0);
  bench.add({bench.mesh.triangle_edges()[20][0], 0.5});
  REQUIRE(bench.lines.size() == 1);
  int occupied_below = 0, occupied_above = 0;
  for (std::int32_t edge = 0; edge < bench.edge_count(); ++edge) {
    const bool above = bench.mesh.vertices()[bench.mesh.edges()[edge][0]][2] > 0;
    (above ? occupied_above : occupied_below) += bench.occupied_count(edge);
  }
  CHECK(occupied_above == 0);
  CHECK(occupied_below > 0);
}

TEST_CASE("edge mask: two sides of a fold are far from each other along the surface") {
  // A long strip folded in the middle: the far half lies 0.2 above the near half.
  const auto strip = mapped(jittered_grid(20, 4, 0.5),
                            [](const Vector& v) { return v.x() <= 5 ? v : Vector(10 - v.x() + 0.2, v.y(), 0.2); });
  Bench bench(strip, 0.4, 0);
  const auto vertical = [](const SurfaceMesh& mesh) { return constant_field(mesh, Vector(0.02, 1, 0)); };
  const auto field = vertical(bench.mesh);
  const StreamlineTracer tracer(bench.mesh, field, {0.4});
  const auto workspace = StreamlineTracer::make_workspace();
  // Across the strip at x of about 2, 3 from the fold.
  const auto& line = tracer.trace(EdgePoint{bench.mesh.triangle_edges()[8][0], 0.5}, nullptr, *workspace);
  REQUIRE(line.length > 1.9);
  bench.mask->add(line);
  for (std::int32_t edge = 0; edge < bench.edge_count(); ++edge) {
    const auto [a, b] = bench.mesh.edges()[edge];
    const bool above = std::max(bench.mesh.vertices()[a][2], bench.mesh.vertices()[b][2]) > 0.1;
    if (above) CHECK(bench.occupied_count(edge) == 0);
  }
  CHECK(bench.mask->coverage() > 0.02);
}

TEST_CASE("edge mask: a slit that ends within an edge of the band does not part its sides") {
  // Two columns of squares, joined from y = 9 upwards only; their other sides coincide. A segment across the left one
  // at y = 8.2 is 0.8 from there.
  Soup soup = grid(2, 10);
  for (int j = 0; j < 9; ++j) soup.vertices.push_back(soup.vertices[1 + 3 * j]);
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    for (auto& v : soup.triangles[t]) {
      const bool is_right = t % 4 >= 2;
      if (is_right && v % 3 == 1 && v < 27) v = 33 + v / 3;
    }
  }
  const auto mesh = soup.mesh();
  REQUIRE(mesh.boundary_loops().size() == 1);
  const auto field = constant_field(mesh, Vector(1, 1e-3, 0));
  for (const double separation : {0.7, 0.9}) {
    const StreamlineTracer tracer(mesh, field, {separation});
    const auto mask = make_edge_mask(mesh, tracer);
    const auto workspace = StreamlineTracer::make_workspace();
    const auto left_border = mesh.triangle_edges()[4 * 8 + 1][2];  // from (0, 8) to (0, 9)
    const auto& line =
        tracer.trace(EdgePoint{left_border, mesh.runs_along(4 * 8 + 1, 2) ? 0.8 : 0.2}, nullptr, *workspace);
    mask->add(line);
    const auto at = places(mesh, line);
    REQUIRE(line.length == doctest::Approx(1).epsilon(1e-5));
    REQUIRE(at[0].y() == doctest::Approx(8.2).epsilon(1e-3));
    for (std::int32_t edge = 0; edge < static_cast<std::int32_t>(mesh.edges().size()); ++edge) {
      for (int i = 0; i < sub_segments; ++i) {
        const EdgePoint point{edge, (i + 0.5) / sub_segments};
        if (mask->admits(0, 0.5, point)) CHECK(distance_to_polyline(detail::position(mesh, point), at) > separation);
      }
    }
  }
}

TEST_CASE("edge mask: the search crosses a cut, where surfaces touch") {
  const auto mesh = three_on_an_edge().mesh();
  const auto field = constant_field(mesh, Vector(0.3, 0.2, 1));
  const StreamlineTracer tracer(mesh, field, {0.3});
  const auto mask = make_edge_mask(mesh, tracer);
  const auto workspace = StreamlineTracer::make_workspace();
  const auto shared = mesh.triangle_edges()[0][0];
  REQUIRE(mesh.edge_triangles(shared).size() == 3);
  mask->add(tracer.trace(EdgePoint{shared, 0.5}, nullptr, *workspace));
  for (std::int32_t t = 0; t < 3; ++t) {
    int touched = 0;
    for (const auto edge : mesh.triangle_edges()[t]) {
      if (edge == shared) continue;
      for (int i = 0; i < sub_segments; ++i) touched += !mask->admits(t, 0.5, {edge, (i + 0.5) / sub_segments});
    }
    CHECK(touched > 0);
  }
}

TEST_CASE("edge mask: seeds are drawn evenly by length from what is free") {
  Bench bench(jittered_grid(4, 3), 0.35, 0);
  bench.add({bench.mesh.triangle_edges()[5][1], 0.5});
  Random random(8);
  for (const auto region : {SeedRegion::free, SeedRegion::partly_free, SeedRegion::wholly_free}) {
    std::vector<double> weights(bench.edge_count(), 0);
    double total = 0;
    for (std::int32_t edge = 0; edge < bench.edge_count(); ++edge) {
      const int occupied = bench.occupied_count(edge);
      const bool counts = region == SeedRegion::free || (region == SeedRegion::wholly_free) == (occupied == 0);
      weights[edge] = counts ? (sub_segments - occupied) * bench.mesh.edge_lengths()[edge] : 0;
      total += weights[edge];
    }
    const int draws = 40000;
    std::vector<int> counts(bench.edge_count(), 0);
    double sum_of_positions = 0;
    for (int i = 0; i < draws; ++i) {
      const auto seed = bench.mask->draw_seed(region, random);
      REQUIRE(seed.has_value());
      CHECK(bench.mask->admits_seed(*seed));
      ++counts[seed->point.edge];
      if (bench.occupied_count(seed->point.edge) == 0) sum_of_positions += seed->point.position - 0.5;
    }
    double chi_square = 0;
    int freedom = -1;
    for (std::int32_t edge = 0; edge < bench.edge_count(); ++edge) {
      const double expected = draws * weights[edge] / total;
      if (expected == 0) CHECK(counts[edge] == 0);
      if (expected == 0) continue;
      chi_square += (counts[edge] - expected) * (counts[edge] - expected) / expected;
      ++freedom;
    }
    REQUIRE(freedom > 3);
    CHECK(chi_square < freedom + 5 * std::sqrt(2.0 * freedom));
    CHECK(std::abs(sum_of_positions) < 5 * std::sqrt(draws / 12.0));
  }
}

TEST_CASE("edge mask: a drawn point may be anywhere in its free sub-segment") {
  Bench bench(one_triangle(), 0.1, 0);
  Random random(9);
  std::map<std::int32_t, std::vector<double>> positions;
  for (int i = 0; i < 3000; ++i) {
    const auto seed = bench.mask->draw_seed(SeedRegion::free, random);
    REQUIRE(seed.has_value());
    const double place = seed->point.position * sub_segments;
    positions[seed->point.edge].push_back(place - std::floor(place));
  }
  CHECK(positions.size() == 3);
  for (const auto& [edge, within] : positions) {
    CHECK(*std::min_element(within.begin(), within.end()) < 0.01);
    CHECK(*std::max_element(within.begin(), within.end()) > 0.99);
  }
}

TEST_CASE("edge mask: a retired seed is not drawn again, but can be crossed and is not covered") {
  Bench bench(one_triangle(), 0.1, 0);
  Random random(9);
  for (int left = 3 * sub_segments; left > 0; --left) {
    const auto seed = bench.mask->draw_seed(SeedRegion::free, random);
    REQUIRE(seed.has_value());
    bench.mask->retire_seed(*seed);
    CHECK(!bench.mask->admits_seed(*seed));
    CHECK(bench.mask->admits(0, 0.5, seed->point));
  }
  for (const auto region : {SeedRegion::free, SeedRegion::partly_free, SeedRegion::wholly_free}) {
    CHECK(bench.mask->draw_seed(region, random) == std::nullopt);
  }
  CHECK(bench.mask->coverage() == 0);
}

TEST_CASE("edge mask: a line that covers all leaves nothing to draw") {
  Bench bench(jittered_grid(4, 3), 100, 0);
  bench.add({0, 0.5});
  CHECK(bench.mask->coverage() == 1);
  Random random(1);
  CHECK(bench.mask->draw_seed(SeedRegion::free, random) == std::nullopt);
}

TEST_CASE("edge mask: edges where no streamline can start are neither drawn nor counted") {
  const auto mesh = together(one_triangle(), moved(one_triangle(), {3, 0, 0})).mesh();
  const auto field = OrientationField::from_triangle_vectors(mesh, std::vector<Vec3>{{1, 0.3, 0}, {0, 0, 0}});
  const StreamlineTracer tracer(mesh, field, {5});
  const auto mask = make_edge_mask(mesh, tracer);
  Random random(1);
  for (int i = 0; i < 500; ++i) CHECK(mask->draw_seed(SeedRegion::free, random)->triangle == 0);
  const auto workspace = StreamlineTracer::make_workspace();
  mask->add(tracer.trace(EdgePoint{mesh.triangle_edges()[0][0], 0.4}, nullptr, *workspace));
  CHECK(mask->coverage() == 1);
}

}  // namespace pectinate::test
