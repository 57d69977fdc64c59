// SPDX-License-Identifier: MIT
#include "pectinate/placement.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <stdexcept>
#include <thread>

#include "pectinate/errors.hpp"
#include "placement_checks.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;
using detail::vector;

constexpr auto methods = {PlacementMethod::random, PlacementMethod::neighborhood, PlacementMethod::distance};

PlacementOptions with(double separation, PlacementMethod method = PlacementMethod::distance, int seed_count = 8) {
  PlacementOptions options;
  options.separation_distance = separation;
  options.method = method;
  options.seed_count = seed_count;
  return options;
}

double mean_length(const SurfaceMesh& mesh, const OrientationField& field, PlacementMethod method, int seed_count) {
  double sum = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    auto options = with(0.8, method, seed_count);
    options.random_seed = seed;
    sum += place_streamlines(mesh, field, options).statistics.mean_length;
  }
  return sum;
}

}  // namespace

TEST_CASE("placement: lines keep d_sep at their points and leave no gap") {
  for (const auto& soup : {jittered_grid(16, 12), sphere(3, 4)}) {
    const auto mesh = soup.mesh();
    const auto field = smooth_field(mesh);
    for (const auto method : methods) {
      for (const double separation : {0.6, 1.7}) {
        const auto placement = checked(mesh, field, with(separation, method));
        check_separation(placement, separation);
        CHECK(check_filled(mesh, field, placement) > 0.99);
      }
    }
  }
}

TEST_CASE("placement: a field without any order is filled just as well") {
  const auto mesh = jittered_grid(12, 9).mesh();
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto field = random_field(mesh, seed);
    for (const double separation : {0.3, 1.0, 3.0}) {
      const auto placement = checked(mesh, field, with(separation));
      check_separation(placement, separation);
      CHECK(std::abs(check_filled(mesh, field, placement) - placement.statistics.coverage) < 0.02);
    }
  }
}

TEST_CASE("placement: the number of threads changes no byte") {
  const auto mesh = sphere(4, 4).mesh();
  const auto field = smooth_field(mesh);
  for (const auto method : methods) {
    auto options = with(0.8, method, 13);
    const auto expected = place_streamlines(mesh, field, options);
    for (const int threads : {1, 2, 3, 7}) {
      options.thread_count = threads;
      CHECK(same_bytes(place_streamlines(mesh, field, options), expected));
    }
  }
}

TEST_CASE("placement: the random seed decides, and nothing else") {
  const auto mesh = jittered_grid(16, 12).mesh();
  const auto field = smooth_field(mesh);
  auto options = with(0.9);
  const auto expected = place_streamlines(mesh, field, options);
  CHECK(same_bytes(place_streamlines(mesh, field, options), expected));
  options.progress = [](double) { return true; };
  CHECK(same_bytes(place_streamlines(mesh, field, options), expected));
  options.random_seed += 1;
  CHECK(!same_bytes(place_streamlines(mesh, field, options), expected));
}

TEST_CASE("placement: reversing any of the vectors changes no byte") {
  const auto mesh = sphere(3, 4).mesh();
  const auto function = [](const Vector& c, const Vector&) { return Vector(c.y() + 0.1, c.z(), 1); };
  const auto vectors = triangle_vectors(mesh, function);
  const auto expected = place_streamlines(mesh, OrientationField::from_triangle_vectors(mesh, vectors), with(0.7));
  Random random(1);
  for (int round = 0; round < 3; ++round) {
    auto reversed = vectors;
    for (auto& v : reversed) {
      if (random.below(2)) v = {-v[0], -v[1], -v[2]};
    }
    CHECK(same_bytes(place_streamlines(mesh, OrientationField::from_triangle_vectors(mesh, reversed), with(0.7)),
                     expected));
  }
}

TEST_CASE("placement: it moves with the surface and grows with it") {
  const auto soup = jittered_grid(16, 12);
  const auto mesh = soup.mesh();
  const auto vectors =
      triangle_vectors(mesh, [](const Vector& c, const Vector&) { return Vector(1, std::sin(0.3 * c.x()), 0); });
  const auto expected = place_streamlines(mesh, OrientationField::from_triangle_vectors(mesh, vectors), with(0.9));
  const auto placed = [&](const Eigen::Matrix3d& rotation, double scale, const Vector& offset) {
    auto turned = vectors;
    for (auto& v : turned) v = detail::vec3(rotation * vector(v));
    const auto other = mapped(soup, [&](const Vector& v) { return Vector(scale * (rotation * v) + offset); }).mesh();
    return place_streamlines(other, OrientationField::from_triangle_vectors(other, turned), with(0.9 * scale));
  };
  const Vector offset(30, -50, 20);
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

TEST_CASE("placement: every kind of surface is filled") {
  const auto soups = {torus(30, 14),        cylinder(20, 12, 1, 3), moebius_strip(40, 6),
                      klein_bottle(30, 20), three_on_an_edge(),     bow_tie(),
                      one_triangle(),       tetrahedron(),          together(sphere(2), moved(sphere(2), {3, 0, 0}))};
  for (const auto& soup : soups) {
    const auto mesh = soup.mesh();
    for (const auto method : methods) {
      for (const double separation : {0.05, 0.2, 50.0}) {
        const auto field = smooth_field(mesh);
        const auto placement = checked(mesh, field, with(separation, method, 3));
        if (mesh.triangle_count() < 200) check_filled(mesh, field, placement);
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
    const auto placement = place_streamlines(mesh, constant_field(mesh, Vector(1, 0.3, 0)), with(1.5 * scale));
    CHECK(placement.end == PlacementEnd::complete);
    CHECK(!placement.lengths.empty());
  }
}

TEST_CASE("placement: a surface smaller than d_sep gets one line") {
  const auto mesh = jittered_grid(5, 4).mesh();
  const auto placement = checked(mesh, smooth_field(mesh), with(20));
  CHECK(placement.lengths.size() == 1);
  CHECK(placement.statistics.coverage == 1);
}

TEST_CASE("placement: triangles without a direction stay empty") {
  const auto mesh = jittered_grid(12, 8).mesh();
  const auto field = field_of(mesh, [](const Vector& c, const Vector&) {
    const bool inside = (c - Vector(6, 4, 0)).norm() < 2;
    return inside ? Vector(0, 0, 0) : Vector(1, 0.2, 0);
  });
  const auto placement = checked(mesh, field, with(0.5));
  for (const auto t : placement.segment_triangles) CHECK(field.has_direction(t));
  CHECK(placement.statistics.stop_counts[static_cast<int>(StopReason::no_field)] > 0);
  CHECK(check_filled(mesh, field, placement) > 0.99);
}

TEST_CASE("placement: parallel lines are whole and between d_sep and 2 d_sep apart") {
  const auto mesh = jittered_grid(30, 12).mesh();
  const auto field = constant_field(mesh, Vector(1, 1e-3, 0));
  for (const auto method : methods) {
    const auto placement = checked(mesh, field, with(1.3, method, 16));
    const auto& statistics = placement.statistics;
    CHECK(statistics.mean_spacing_ratio > 0.9);  // the outer lines may lie on the border
    CHECK(statistics.mean_spacing_ratio < 2);
    CHECK(statistics.length_weighted_mean > 20);
  }
}

TEST_CASE("placement: more candidates give longer lines") {
  const auto mesh = jittered_grid(20, 16).mesh();
  const auto field = smooth_field(mesh);
  for (const auto method : methods) {
    CHECK(mean_length(mesh, field, method, 1) < mean_length(mesh, field, method, 32));
  }
}

TEST_CASE("placement: the first line is the longest of its candidates") {
  const auto mesh = jittered_grid(20, 16).mesh();
  const auto field = smooth_field(mesh);
  const auto options = with(0.8, PlacementMethod::random, 4000);
  const auto placement = place_streamlines(mesh, field, options);
  const StreamlineTracer tracer(mesh, field, {0.8});
  const auto workspace = StreamlineTracer::make_workspace();
  double longest = 0;
  for (std::int32_t edge = 0; edge < static_cast<std::int32_t>(mesh.edges().size()); ++edge) {
    for (const double position : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      longest = std::max(longest, tracer.trace({edge, position}, nullptr, *workspace).length);
    }
  }
  CHECK(placement.lengths[0] > 0.99 * longest);
}

TEST_CASE("placement: the seed is known") {
  const auto mesh = jittered_grid(30, 20).mesh();
  auto options = with(0.8);
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

TEST_CASE("placement: cancelled, it keeps the lines placed so far") {
  const auto mesh = jittered_grid(20, 16).mesh();
  const auto field = smooth_field(mesh);
  auto options = with(0.4);
  const auto whole = place_streamlines(mesh, field, options);
  int calls = 0;
  std::vector<double> coverages;
  options.progress = [&](double coverage) {
    coverages.push_back(coverage);
    // Longer than the interval between calls: the next step asks again.
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    return ++calls < 4;
  };
  const auto part = place_streamlines(mesh, field, options);
  CHECK(calls == 4);
  CHECK(coverages.front() == 0);
  CHECK(std::is_sorted(coverages.begin(), coverages.end()));
  CHECK(part.end == PlacementEnd::cancelled);
  REQUIRE(!part.lengths.empty());
  REQUIRE(part.lengths.size() < whole.lengths.size());
  CHECK(part.statistics.coverage < whole.statistics.coverage);
  CHECK(std::equal(part.points.begin(), part.points.end(), whole.points.begin()));
  CHECK(std::equal(part.lengths.begin(), part.lengths.end(), whole.lengths.begin()));
  check_lines(mesh, field, part);
  check_points(mesh, part);
  check_statistics(mesh, field, part);
}

TEST_CASE("placement: cancelled at once, it is empty and valid") {
  const auto mesh = jittered_grid(5, 4).mesh();
  const auto field = smooth_field(mesh);
  auto options = with(0.4);
  options.progress = [](double) { return false; };
  const auto placement = place_streamlines(mesh, field, options);
  CHECK(placement.end == PlacementEnd::cancelled);
  CHECK(placement.points.empty());
  CHECK(placement.offsets == std::vector<std::int64_t>{0});
  CHECK(placement.statistics.mean_length == 0);
  CHECK(placement.statistics.mean_spacing == 0);
  CHECK(placement.statistics.surface_area == doctest::Approx(20));
}

TEST_CASE("placement: what the callback throws comes through") {
  const auto mesh = jittered_grid(5, 4).mesh();
  const auto field = smooth_field(mesh);
  for (const int threads : {1, 3}) {
    auto options = with(0.4);
    options.thread_count = threads;
    options.progress = [](double) -> bool { throw std::out_of_range("enough"); };
    CHECK_THROWS_WITH_AS(place_streamlines(mesh, field, options), "enough", std::out_of_range);
  }
}

TEST_CASE("placement: the result carries the options as used") {
  const auto mesh = jittered_grid(5, 4).mesh();
  auto options = with(0.7, PlacementMethod::neighborhood, 5);
  options.random_seed = 99;
  options.seed_distance_factor = 1.7;
  options.abrupt_turn_angle = 1;
  options.max_steps = 17;
  options.thread_count = 2;
  options.progress = [](double) { return true; };
  const auto used = checked(mesh, smooth_field(mesh), options).options;
  CHECK(used.separation_distance == 0.7);
  CHECK(used.method == PlacementMethod::neighborhood);
  CHECK(used.seed_count == 5);
  CHECK(used.random_seed == 99);
  CHECK(used.seed_distance_factor == 1.7);
  CHECK(used.abrupt_turn_angle == 1);
  CHECK(used.max_steps == 17);
  CHECK(used.thread_count == 2);
  CHECK(!used.progress);
}

TEST_CASE("placement: options out of range are refused") {
  const auto mesh = jittered_grid(5, 4).mesh();
  const auto field = smooth_field(mesh);
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const auto refused = [&](const std::function<void(PlacementOptions&)>& spoil) {
    PlacementOptions options;
    spoil(options);
    CHECK_THROWS_AS(place_streamlines(mesh, field, options), InvalidOption);
  };
  for (const double bad : {0.0, -1.0, nan, infinity, 1e-12}) {
    refused([=](auto& options) { options.separation_distance = bad; });
  }
  for (const double bad : {0.999, -1.0, nan, infinity}) {
    refused([=](auto& options) { options.seed_distance_factor = bad; });
  }
  for (const double bad : {0.0, -0.1, 3.15, nan}) refused([=](auto& options) { options.abrupt_turn_angle = bad; });
  for (const int bad : {0, -1}) {
    refused([=](auto& options) { options.seed_count = bad; });
    refused([=](auto& options) { options.max_steps = bad; });
    refused([=](auto& options) { options.thread_count = bad; });
  }
  refused([](auto& options) { options.thread_count = 1 << 20; });
  const auto small = one_triangle().mesh();
  CHECK_THROWS_AS(place_streamlines(small, field, {}), InvalidField);
}

}  // namespace pectinate::test
