// SPDX-License-Identifier: MIT
#include "detail/curve_order.hpp"

#include <algorithm>
#include <numeric>

#include "detail/large_array.hpp"
#include "detail/vec.hpp"

namespace pectinate::detail {
namespace {

/// Cells of the curve: so many bits an axis, and two passes of the sort.
constexpr int bits_per_axis = 8, bits_per_pass = 12;
constexpr std::uint32_t cells_per_axis = 1U << bits_per_axis;

/// Eight bits, spread so that two others go between each.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 8) & 0x00f00fU;
  bits = (bits | bits << 4) & 0x0c30c3U;
  return (bits | bits << 2) & 0x249249U;
}

/// Each point's place on the Morton curve through the cells of the bounding box.
std::span<const std::uint32_t> curve_keys(std::span<const Vec3> points, Scratch& scratch) {
  Vector low = vector(points[0]), high = low;
  for (const auto& point : points) {
    low = low.cwiseMin(vector(point));
    high = high.cwiseMax(vector(point));
  }
  const double scale = cells_per_axis / (high - low).maxCoeff();
  const auto cell = [&](double offset) {
    const double x = offset * scale;
    return spread(x < cells_per_axis ? static_cast<std::uint32_t>(x) : cells_per_axis - 1);
  };
  const auto keys = scratch.array<std::uint32_t>(points.size());
  std::ranges::transform(points, keys.begin(), [&](const Vec3& point) {
    return cell(point[0] - low.x()) | cell(point[1] - low.y()) << 1 | cell(point[2] - low.z()) << 2;
  });
  return keys;
}

/// Where each item comes when all are sorted by a key below `key_count`; equals keep their order.
template <class Key>
void rank_by(std::size_t key_count, const Key& key, std::span<std::int32_t> ranks, Scratch& scratch) {
  const auto starts = scratch.array<std::int32_t>(key_count + 1, 0);
  for (std::size_t i = 0; i < ranks.size(); ++i) ++starts[key(i) + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  for (std::size_t i = 0; i < ranks.size(); ++i) ranks[i] = starts[key(i)]++;
}

}  // namespace

std::vector<std::int32_t> curve_ranks(std::span<const Vec3> points, Scratch& scratch) {
  constexpr std::uint32_t digits = 1U << bits_per_pass;
  scratch.next_step();
  const auto keys = curve_keys(points, scratch);
  const auto by_low_digit = scratch.array<std::int32_t>(points.size());
  rank_by(digits, [&](std::size_t i) { return keys[i] % digits; }, by_low_digit, scratch);
  const auto order = scratch.array<std::int32_t>(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) order[by_low_digit[i]] = static_cast<std::int32_t>(i);
  const auto by_both = scratch.array<std::int32_t>(points.size());
  rank_by(digits, [&](std::size_t i) { return keys[order[i]] / digits; }, by_both, scratch);
  auto ranks = roomy_vector<std::int32_t>(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) ranks[order[i]] = by_both[i];
  return ranks;
}

std::vector<std::int32_t> ranks_by_corner(std::span<const Triangle> triangles,
                                          const std::vector<std::int32_t>& vertex_ranks, Scratch& scratch) {
  scratch.next_step();
  auto ranks = roomy_vector<std::int32_t>(triangles.size(), 0);
  const auto least_corner = [&](std::size_t t) {
    const auto& [a, b, c] = triangles[t];
    return std::min({vertex_ranks[a], vertex_ranks[b], vertex_ranks[c]});
  };
  rank_by(vertex_ranks.size(), least_corner, ranks, scratch);
  return ranks;
}

}  // namespace pectinate::detail
