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
std::vector<std::uint32_t> curve_keys(std::span<const Vec3> points) {
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
  auto keys = roomy_vector<std::uint32_t>(points.size());
  for (const auto& point : points) {
    keys.push_back(cell(point[0] - low.x()) | cell(point[1] - low.y()) << 1 | cell(point[2] - low.z()) << 2);
  }
  return keys;
}

/// Where each item comes when all are sorted by a key below `key_count`; equals keep their order.
template <class Key>
std::vector<std::int32_t> ranks_by(std::size_t count, std::size_t key_count, const Key& key) {
  auto starts = roomy_vector<std::int32_t>(key_count + 1, 0), ranks = roomy_vector<std::int32_t>(count, 0);
  for (std::size_t i = 0; i < count; ++i) ++starts[key(i) + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  for (std::size_t i = 0; i < count; ++i) ranks[i] = starts[key(i)]++;
  return ranks;
}

}  // namespace

std::vector<std::int32_t> curve_ranks(std::span<const Vec3> points) {
  constexpr std::uint32_t digits = 1U << bits_per_pass;
  const auto keys = curve_keys(points);
  const auto by_low_digit = ranks_by(points.size(), digits, [&](std::size_t i) { return keys[i] % digits; });
  auto order = roomy_vector<std::int32_t>(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) order[by_low_digit[i]] = static_cast<std::int32_t>(i);
  const auto by_both = ranks_by(points.size(), digits, [&](std::size_t i) { return keys[order[i]] / digits; });
  auto ranks = roomy_vector<std::int32_t>(points.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) ranks[order[i]] = by_both[i];
  return ranks;
}

std::vector<std::int32_t> ranks_by_corner(std::span<const Triangle> triangles,
                                          const std::vector<std::int32_t>& vertex_ranks) {
  return ranks_by(triangles.size(), vertex_ranks.size(), [&](std::size_t t) {
    const auto& [a, b, c] = triangles[t];
    return std::min({vertex_ranks[a], vertex_ranks[b], vertex_ranks[c]});
  });
}

}  // namespace pectinate::detail
