// SPDX-License-Identifier: MIT
#include "pectinate/placement.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "placement_checks.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;
using detail::vector;

/// How streamlines are placed.
struct Way {
  PlacementMethod method;
  OccupancyModel occupancy;
};
using enum PlacementMethod;
using enum OccupancyModel;

constexpr Way default_way{longest, exact};
constexpr auto ways = {Way{PlacementMethod::random, edge_mask},
                       Way{neighborhood, edge_mask},
                       Way{PlacementMethod::distance, edge_mask},
                       Way{PlacementMethod::random, exact},
                       Way{neighborhood, exact},
                       Way{PlacementMethod::distance, exact},
                       default_way};

PlacementOptions with(double separation, Way way = default_way, int seed_count = 8) {
  PlacementOptions options;
  options.separation_distance = separation;
  options.method = way.method;
  options.occupancy = way.occupancy;
  options.seed_count = seed_count;
  return options;
}

double mean_length(const SurfaceMesh& mesh, const OrientationField& field, Way way, int seed_count) {
  double sum = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    auto options = with(0.8, way, seed_count);
    options.random_seed = seed;
    sum += place_streamlines(mesh, field, options).statistics.mean_length;
  }
  return sum;
}

/// As far apart as the occupancy model promises, and nothing left between.
void check_even(const SurfaceMesh& mesh, const OrientationField& field, const Placement& placement) {
  const double separation = placement.options.separation_distance;
  if (placement.options.occupancy == edge_mask) {
    check_separation(placement, separation);
    check_filled(mesh, field, placement);
  } else {
    check_segment_separation(placement, separation);
    check_complete(mesh, field, placement);
  }
  if (placement.options.method == longest) check_self_separation(placement, separation);
}

}  // namespace

TEST_CASE("placement: lines keep d_sep and leave no gap") {
  for (const auto& soup : {jittered_grid(16, 12), sphere(3, 4)}) {
    const auto mesh = soup.mesh();
    const auto field = smooth_field(mesh);
    for (const auto way : ways) {
      for (const double separation : {0.6, 1.7}) {
        const auto placement = checked(mesh, field, with(separation, way));
        check_even(mesh, field, placement);
        CHECK(placement.statistics.coverage > (way.occupancy == exact ? 1 - 1e-6 : 0.99));
      }
    }
  }
}

TEST_CASE("placement: a field without any order is filled just as well") {
  const auto mesh = jittered_grid(12, 9).mesh();
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto field = random_field(mesh, seed);
    for (const double separation : {0.3, 1.0, 3.0}) {
      for (const auto way : {Way{PlacementMethod::distance, edge_mask}, Way{neighborhood, exact}, default_way}) {
        check_even(mesh, field, checked(mesh, field, with(separation, way)));
      }
    }
  }
}

TEST_CASE("placement: the number of threads changes no byte") {
  const auto mesh = sphere(4, 4).mesh();
  const auto field = smooth_field(mesh);
  for (const auto way : ways) {
    for (const int seed_count : {13, 300}) {  // too few for threads to share, and enough
      auto options = with(0.8, way, seed_count);
      const auto expected = place_streamlines(mesh, field, options);
      for (const int threads : {1, 2, 3, 7}) {
        options.thread_count = threads;
        CHECK(same_bytes(place_streamlines(mesh, field, options), expected));
      }
    }
  }
}

TEST_CASE("placement: the random seed decides, and nothing else; method longest draws nothing") {
  const auto mesh = jittered_grid(16, 12).mesh();
  const auto field = smooth_field(mesh);
  for (const auto way : ways) {
    auto options = with(0.9, way);
    const auto expected = place_streamlines(mesh, field, options);
    CHECK(same_bytes(place_streamlines(mesh, field, options), expected));
    options.progress = [](double) { return true; };
    CHECK(same_bytes(place_streamlines(mesh, field, options), expected));
    options.random_seed += 1;
    CHECK(same_bytes(place_streamlines(mesh, field, options), expected) == (way.method == longest));
  }
}

TEST_CASE("placement: reversing any of the vectors changes no byte") {
  const auto mesh = sphere(3, 4).mesh();
  const auto function = [](const Vector& c, const Vector&) { return Vector(c.y() + 0.1, c.z(), 1); };
  const auto vectors = triangle_vectors(mesh, function);
  const auto placed = [&](const std::vector<Vec3>& rows, Way way) {
    return place_streamlines(mesh, OrientationField::from_triangle_vectors(mesh, rows), with(0.7, way));
  };
  Random random(1);
  for (const auto way : ways) {
    auto reversed = vectors;
    for (auto& v : reversed) {
      if (random.below(2)) v = {-v[0], -v[1], -v[2]};
    }
    CHECK(same_bytes(placed(reversed, way), placed(vectors, way)));
  }
}

TEST_CASE("placement: it moves with the surface and grows with it") {
  const auto soup = jittered_grid(16, 12);
  const auto mesh = soup.mesh();
  const auto vectors =
      triangle_vectors(mesh, [](const Vector& c, const Vector&) { return Vector(1, std::sin(0.3 * c.x()), 0); });
  const Vector offset(30, -50, 20);
  for (const auto way : ways) {
    const auto expected =
        place_streamlines(mesh, OrientationField::from_triangle_vectors(mesh, vectors), with(0.9, way));
    const auto placed = [&](const Eigen::Matrix3d& rotation, double scale, const Vector& shift) {
      auto turned = vectors;
      for (auto& v : turned) v = detail::vec3(rotation * vector(v));
      const auto other = mapped(soup, [&](const Vector& v) { return Vector(scale * (rotation * v) + shift); }).mesh();
      return place_streamlines(other, OrientationField::from_triangle_vectors(other, turned), with(0.9 * scale, way));
    };
    const auto moved_placement = placed(some_rotation(), 1, offset);
    REQUIRE(moved_placement.segment_triangles == expected.segment_triangles);
    CHECK(moved_placement.offsets == expected.offsets);
    CHECK(moved_placement.stop_reasons == expected.stop_reasons);
    for (std::size_t p = 0; p < expected.points.size(); ++p) {
      const Vector moved_point = some_rotation() * vector(expected.points[p]) + offset;
      CHECK((vector(moved_placement.points[p]) - moved_point).norm() < 1e-9);
    }
    // A power of two changes exponents only.
    const auto grown = placed(Eigen::Matrix3d::Identity(), 4, Vector(0, 0, 0));
    CHECK(grown.segment_triangles == expected.segment_triangles);
    CHECK(grown.barycentric == expected.barycentric);
    for (std::size_t i = 0; i < expected.lengths.size(); ++i) CHECK(grown.lengths[i] == 4 * expected.lengths[i]);
  }
}

TEST_CASE("placement: every kind of surface is filled") {
  const auto soups = {torus(30, 14),        cylinder(20, 12, 1, 3), moebius_strip(40, 6),
                      klein_bottle(30, 20), three_on_an_edge(),     bow_tie(),
                      one_triangle(),       tetrahedron(),          together(sphere(2), moved(sphere(2), {3, 0, 0}))};
  for (const auto& soup : soups) {
    const auto mesh = soup.mesh();
    for (const auto way : ways) {
      for (const double separation : {0.05, 0.2, 50.0}) {
        const auto field = smooth_field(mesh);
        const auto placement = checked(mesh, field, with(separation, way, 3));
        if (way.occupancy == exact) check_complete(mesh, field, placement, 5);
        if (way.occupancy == edge_mask && mesh.triangle_count() < 200) check_filled(mesh, field, placement);
        std::vector<bool> reached(mesh.components().size(), false);
        for (const auto t : placement.segment_triangles) reached[mesh.triangle_components()[t]] = true;
        // The search crosses cuts, so that a line on one of several sheets may cover the others.
        const bool has_cuts = !mesh.repairs().split_vertices.empty();
        if (!has_cuts) CHECK(std::count(reached.begin(), reached.end(), false) == 0);
      }
    }
  }
}

TEST_CASE("placement: it ends, even where squares of lengths overflow or vanish") {
  for (const double scale : {1e-75, 1e-40, 1e40, 1e76, 1e77}) {
    const auto soup = mapped(jittered_grid(6, 5), [=](const Vector& v) { return Vector(scale * v); });
    const auto mesh = soup.mesh();
    const auto field = constant_field(mesh, Vector(1, 0.3, 0));
    for (const auto way : ways) {
      const auto placement = place_streamlines(mesh, field, with(1.5 * scale, way));
      CHECK(placement.end == PlacementEnd::complete);
      CHECK(!placement.lengths.empty());
    }
  }
}

TEST_CASE("placement: a surface smaller than d_sep gets one line") {
  const auto mesh = jittered_grid(5, 4).mesh();
  for (const auto way : ways) {
    const auto placement = checked(mesh, smooth_field(mesh), with(20, way));
    CHECK(placement.lengths.size() == 1);
    CHECK(placement.statistics.coverage == 1);
  }
}

TEST_CASE("placement: triangles without a direction stay empty") {
  const auto mesh = jittered_grid(12, 8).mesh();
  const auto field = field_of(mesh, [](const Vector& c, const Vector&) {
    const bool inside = (c - Vector(6, 4, 0)).norm() < 2;
    return inside ? Vector(0, 0, 0) : Vector(1, 0.2, 0);
  });
  for (const auto way : ways) {
    const auto placement = checked(mesh, field, with(0.5, way));
    for (const auto t : placement.segment_triangles) CHECK(field.has_direction(t));
    CHECK(placement.statistics.stop_counts[static_cast<int>(StopReason::no_field)] > 0);
    CHECK(placement.statistics.coverage > 0.99);
    check_even(mesh, field, placement);
  }
}

TEST_CASE("placement: parallel lines are whole and between d_sep and 2 d_sep apart") {
  const auto mesh = jittered_grid(30, 12).mesh();
  const auto field = constant_field(mesh, Vector(1, 1e-3, 0));
  for (const auto way : ways) {
    const auto placement = checked(mesh, field, with(1.3, way, 16));
    const auto& statistics = placement.statistics;
    CHECK(statistics.mean_spacing_ratio > 0.9);  // the outer lines may lie on the border
    CHECK(statistics.mean_spacing_ratio < 2);
    CHECK(statistics.length_weighted_mean > 20);
  }
}

TEST_CASE("placement: more candidates give longer lines") {
  const auto mesh = jittered_grid(20, 16).mesh();
  const auto field = smooth_field(mesh);
  for (const auto way : ways) {
    if (way.method != longest) CHECK(mean_length(mesh, field, way, 1) < mean_length(mesh, field, way, 32));
  }
}

TEST_CASE("placement: the first line is the longest of its candidates") {
  const auto mesh = jittered_grid(20, 16).mesh();
  const auto field = smooth_field(mesh);
  const StreamlineTracer tracer(mesh, field, {0.8});
  const auto workspace = StreamlineTracer::make_workspace();
  double greatest = 0;
  for (std::int32_t edge = 0; edge < static_cast<std::int32_t>(mesh.edges().size()); ++edge) {
    for (const double position : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      greatest = std::max(greatest, tracer.trace(EdgePoint{edge, position}, nullptr, *workspace).length);
    }
  }
  for (const auto way : {Way{PlacementMethod::random, edge_mask}, Way{PlacementMethod::random, exact}, default_way}) {
    const double first = place_streamlines(mesh, field, with(0.8, way, 4000)).lengths[0];
    CHECK(first > (way.method == longest ? 0.95 : 0.99) * greatest);  // of a pool that is a few triangles wide
  }
}

TEST_CASE("placement: the paper's methods tell the seed") {
  const auto mesh = jittered_grid(30, 20).mesh();
  for (const auto way : ways) {
    if (way.method == longest) continue;
    auto options = with(0.8, way);
    options.max_steps = 3;
    const auto placement = checked(mesh, smooth_field(mesh), options);
    int whole = 0;
    for (std::size_t i = 0; i < placement.lengths.size(); ++i) {
      if (placement.stop_reasons[i] != std::array{StopReason::max_steps, StopReason::max_steps}) continue;
      CHECK(placement.seed_points[i] == placement.offsets[i] + 3);
      CHECK(placement.offsets[i + 1] == placement.offsets[i] + 7);
      ++whole;
    }
    CHECK(whole > 0);
  }
}

TEST_CASE("placement: cancelled, it keeps the lines placed so far") {
  // Enough work for a few calls, which are 50 ms apart.
  const auto mesh = sphere(5, 10).mesh();
  const auto field = smooth_field(mesh);
  for (const auto way : {Way{PlacementMethod::distance, edge_mask}, Way{PlacementMethod::random, exact}, default_way}) {
    auto options = with(0.015, way, 200);
    int calls = 0;
    std::vector<double> coverages;
    const auto stop_at = [&](int last) {
      return [&, last](double coverage) {
        coverages.push_back(coverage);
        return ++calls < last;
      };
    };
    options.progress = stop_at(4);
    const auto whole = place_streamlines(mesh, field, options);
    calls = 0;
    options.progress = stop_at(3);
    const auto part = place_streamlines(mesh, field, options);
    CHECK(calls == 3);
    CHECK(coverages.front() == 0);
    CHECK(part.end == PlacementEnd::cancelled);
    REQUIRE(!part.lengths.empty());
    const auto lines = as_placed(part), all_lines = as_placed(whole);
    const auto common = std::min(lines.lengths.size(), all_lines.lengths.size());
    CHECK(std::equal(lines.lengths.begin(), lines.lengths.begin() + common, all_lines.lengths.begin()));
    CHECK(std::equal(lines.points.begin(), lines.points.begin() + lines.offsets[common], all_lines.points.begin()));
    check_lines(mesh, field, part);
    check_points(mesh, part);
    check_statistics(mesh, field, part);
  }
}

TEST_CASE("placement: cancelled at once, it is empty and valid") {
  const auto mesh = jittered_grid(5, 4).mesh();
  const auto field = smooth_field(mesh);
  for (const auto way : ways) {
    auto options = with(0.4, way);
    options.progress = [](double) { return false; };
    const auto placement = place_streamlines(mesh, field, options);
    CHECK(placement.end == PlacementEnd::cancelled);
    CHECK(placement.points.empty());
    CHECK(placement.offsets == std::vector<std::int64_t>{0});
    CHECK(placement.statistics.mean_length == 0);
    CHECK(placement.statistics.mean_spacing == 0);
    CHECK(placement.statistics.surface_area == doctest::Approx(20));
  }
}

TEST_CASE("placement: what the callback throws comes through") {
  const auto mesh = jittered_grid(5, 4).mesh();
  const auto field = smooth_field(mesh);
  for (const auto way : ways) {
    for (const int threads : {1, 3}) {
      auto options = with(0.4, way);
      options.thread_count = threads;
      options.progress = [](double) -> bool { throw std::out_of_range("enough"); };
      CHECK_THROWS_WITH_AS(place_streamlines(mesh, field, options), "enough", std::out_of_range);
    }
  }
}

}  // namespace pectinate::test
