// SPDX-License-Identifier: MIT
#include "pectinate/statistics.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>

#include "meshes.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::test {
namespace {

std::vector<double> random_lengths(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> lengths(count);
  for (auto& length : lengths) length = 10 * random.unit() + 1e-6;
  return lengths;
}

std::int64_t sum(const std::vector<std::int64_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
}

}  // namespace

TEST_CASE("statistics: of lengths that are easy to add") {
  using enum StopReason;
  const std::vector<double> lengths{1, 2, 5};
  const std::vector<std::array<StopReason, 2>> stops{
      {boundary, boundary}, {near_other, no_field}, {boundary, max_steps}};
  const auto result = placement_statistics(lengths, stops, 24, 1.5, 0.75);
  CHECK(result.streamline_count == 3);
  CHECK(result.total_length == 8);
  CHECK(result.mean_length == 8.0 / 3);
  CHECK(result.length_weighted_mean == 30.0 / 8);
  CHECK(result.surface_area == 24);
  CHECK(result.mean_spacing == 3);
  CHECK(result.mean_spacing_ratio == 2);
  CHECK(result.short_fraction == 1.0 / 3);
  CHECK(result.coverage == 0.75);
  CHECK(result.stop_counts == std::array<std::int64_t, stop_reason_count>{1, 3, 1, 0, 0, 1});
}

TEST_CASE("statistics: identities") {
  const auto lengths = random_lengths(500, 1);
  const std::vector<std::array<StopReason, 2>> stops(500, {StopReason::boundary, StopReason::near_other});
  const auto result = placement_statistics(lengths, stops, 123, 0.8, 1);
  const auto count = static_cast<double>(result.streamline_count);
  CHECK(result.mean_spacing * count * result.mean_length == doctest::Approx(123).epsilon(1e-14));
  CHECK(result.mean_spacing_ratio * 0.8 == doctest::Approx(result.mean_spacing).epsilon(1e-14));
  CHECK(result.length_weighted_mean >= result.mean_length);
  CHECK(result.length_weighted_mean <= *std::max_element(lengths.begin(), lengths.end()));
  const auto shorter = std::count_if(lengths.begin(), lengths.end(), [](double length) { return length < 0.8; });
  CHECK(result.short_fraction * count == doctest::Approx(static_cast<double>(shorter)));
}

TEST_CASE("statistics: of nothing they are zero") {
  const auto result = placement_statistics({}, {}, 5, 1, 0);
  CHECK(result.streamline_count == 0);
  CHECK(result.total_length == 0);
  CHECK(result.mean_length == 0);
  CHECK(result.length_weighted_mean == 0);
  CHECK(result.mean_spacing == 0);
  CHECK(result.mean_spacing_ratio == 0);
  CHECK(result.short_fraction == 0);
  CHECK(result.surface_area == 5);
}

TEST_CASE("histogram: every length is in its bin") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    for (const int bin_count : {1, 2, 3, 7, 10, 49, 1000}) {
      const auto lengths = random_lengths(300, seed);
      const auto [edges, counts] = length_histogram(lengths, bin_count);
      REQUIRE(static_cast<int>(counts.size()) == bin_count);
      REQUIRE(edges.size() == counts.size() + 1);
      CHECK(edges.front() == 0);
      CHECK(edges.back() == *std::max_element(lengths.begin(), lengths.end()));
      CHECK(std::is_sorted(edges.begin(), edges.end()));
      CHECK(sum(counts) == 300);
      for (std::size_t bin = 0; bin < counts.size(); ++bin) {
        const bool is_last = bin + 1 == counts.size();
        CHECK(counts[bin] == std::count_if(lengths.begin(), lengths.end(), [&, first = bin](double length) {
                return length >= edges[first] && (length < edges[first + 1] || is_last);
              }));
      }
    }
  }
}

TEST_CASE("histogram: its last edge is the longest length, whatever the rounding") {
  Random random(4);
  for (int round = 0; round < 2000; ++round) {
    const double length = 100 * random.unit() + 1e-3;
    const auto histogram = length_histogram(std::vector{length}, static_cast<int>(1 + random.below(60)));
    CHECK(histogram.edges.back() == length);
    CHECK(histogram.counts.back() == 1);
  }
}

TEST_CASE("histogram: of nothing it is empty, without bins it is refused") {
  const auto histogram = length_histogram({}, 4);
  CHECK(histogram.edges == std::vector<double>(5, 0));
  CHECK(histogram.counts == std::vector<std::int64_t>(4, 0));
  CHECK_THROWS_AS(length_histogram({}, 0), InvalidOption);
  CHECK_THROWS_AS(length_histogram({}, -3), InvalidOption);
}

}  // namespace pectinate::test
