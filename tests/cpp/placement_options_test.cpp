// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <functional>
#include <limits>

#include "pectinate/errors.hpp"
#include "placement_checks.hpp"

namespace pectinate::test {

TEST_CASE("placement: the result carries the options as used") {
  const auto mesh = jittered_grid(5, 4).mesh();
  PlacementOptions options;
  options.separation_distance = 0.7;
  options.method = PlacementMethod::neighborhood;
  options.seed_count = 5;
  options.seed_clearance = 1.2;
  options.test_distance = 0.9;
  options.minimum_length = 0.3;
  options.singularity_radius = 0.01;
  options.random_seed = 99;
  options.seed_distance_factor = 1.7;
  options.abrupt_turn_angle = 1;
  options.max_steps = 17;
  options.thread_count = 2;
  options.progress = [](double) { return true; };
  const auto used = checked(mesh, smooth_field(mesh), options).options;
  CHECK(used.separation_distance == 0.7);
  CHECK(used.method == PlacementMethod::neighborhood);
  CHECK(used.occupancy == OccupancyModel::exact);
  CHECK(used.seed_clearance == 1.2);
  CHECK(used.test_distance == 0.9);
  CHECK(used.minimum_length == 0.3);
  CHECK(used.singularity_radius == 0.01);
  options.method = PlacementMethod::longest;
  options.close_loops = true;
  options.polishing_rounds = 3;
  options.polishing_time = 100;
  const auto polished = checked(mesh, smooth_field(mesh), options);
  CHECK(polished.options.close_loops);
  CHECK(polished.options.polishing_rounds == 3);
  CHECK(polished.options.polishing_time == 100);
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
  for (const double bad : {-1.0, -1e-300, nan, infinity}) {
    refused([=](auto& options) { options.polishing_time = bad; });
  }
  refused([](auto& options) { options.polishing_rounds = -1; });
  refused([](auto& options) { options.polishing_rounds = std::numeric_limits<std::int64_t>::min(); });
  for (const auto method : {PlacementMethod::random, PlacementMethod::neighborhood, PlacementMethod::distance}) {
    for (const auto occupancy : {OccupancyModel::exact, OccupancyModel::edge_mask}) {
      refused(
          [=](auto& options) { options.method = method, options.occupancy = occupancy, options.polishing_rounds = 1; });
      refused(
          [=](auto& options) { options.method = method, options.occupancy = occupancy, options.polishing_time = 1; });
    }
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
  refused([](auto& options) { options.seed_count = 1'000'001; });
  for (const double bad : {0.999, 2.001, -1.0, nan, infinity})
    refused([=](auto& options) { options.seed_clearance = bad; });
  for (const double bad : {0.0, 1.001, -1.0, nan, infinity})
    refused([=](auto& options) { options.test_distance = bad; });
  for (const double bad : {-1e-9, nan, infinity}) refused([=](auto& options) { options.minimum_length = bad; });
  refused([](auto& options) { options.occupancy = OccupancyModel::edge_mask; });  // method longest needs the exact one
  const auto refused_with_mask = [&](const std::function<void(PlacementOptions&)>& spoil) {
    refused([&](auto& options) {
      options.method = PlacementMethod::neighborhood;
      options.occupancy = OccupancyModel::edge_mask;
      spoil(options);
    });
  };
  refused_with_mask([](auto& options) { options.seed_clearance = 1.1; });
  refused_with_mask([](auto& options) { options.test_distance = 0.8; });
  refused_with_mask([](auto& options) { options.singularity_radius = 0.1; });
  refused_with_mask([](auto& options) { options.close_loops = true; });
  for (const double bad : {-1e-9, nan, infinity}) refused([=](auto& options) { options.singularity_radius = bad; });
  refused([](auto& options) {
    options.method = PlacementMethod::distance;
    options.close_loops = true;
  });
  const std::size_t count = mesh.triangle_count();
  for (const std::size_t size : {std::size_t{1}, count - 1, count + 1}) {
    refused([=](auto& options) { options.separation_distances.assign(size, 1); });
  }
  for (const double bad : {0.0, -1.0, nan, infinity, 1e-12}) {
    refused([=](auto& options) {
      options.separation_distances.assign(count, 1);
      options.separation_distances[count / 2] = bad;
    });
  }
  const auto small = one_triangle().mesh();
  CHECK_THROWS_AS(place_streamlines(small, field, {}), InvalidField);
}

}  // namespace pectinate::test
