// SPDX-License-Identifier: MIT
#include "detail/fans.hpp"

namespace pectinate::detail {
namespace {

/// The corners at a vertex: one of them, as 4 triangle + corner, and how many they are.
struct VertexCorners {
  std::int32_t any = 0, count = 0;
};

std::int32_t count_fan(const Neighbours& neighbours, const Corner& start) {
  std::int32_t count = 0;
  visit_fan(neighbours, start, [&](const Corner&) { ++count; });
  return count;
}

/// Does the fan of a corner close within so many triangles?
bool closes_within(std::int32_t count, const Neighbours& neighbours, const Corner& start) {
  FanSide side{start.triangle, start.corner, true};
  for (std::int32_t i = 0; i < count; ++i) {
    side = side.beyond(side.across(neighbours));
    if (side.triangle() == start.triangle) return true;
  }
  return false;
}

}  // namespace

bool has_one_fan_everywhere(const std::vector<Triangle>& triangles, const Neighbours& neighbours,
                            const std::vector<std::int32_t>& border_triangles, std::size_t vertex_count,
                            Scratch& scratch) {
  scratch.next_step();
  const auto at = scratch.array<VertexCorners>(vertex_count, {});
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      auto& here = at[triangles[t][k]];
      here.any = 4 * t + k;
      here.count += 1;
    }
  }
  std::vector<Corner> border;  // one for each end of a side at a border
  for (const auto t : border_triangles) {
    for (int k = 0; k < 3; ++k) {
      if (!neighbours[t][k].exists()) border.insert(border.end(), {{t, k}, {t, (k + 1) % 3}});
    }
  }
  constexpr std::int32_t done = 0;
  // Every fan at a border is met twice.
  for (const auto& corner : border) {
    const auto count = at[triangles[corner.triangle][corner.corner]].count;
    if (count_fan(neighbours, corner) != count) return false;
  }
  for (const auto& corner : border) at[triangles[corner.triangle][corner.corner]].count = done;
  // The other vertices have closed fans only. None has less than three triangles: two would have the same corners.
  constexpr std::int32_t least = 3;
  for (const auto& [any, count] : at) {
    if (count >= 2 * least && closes_within(count - least, neighbours, {any >> 2, any & 3})) return false;
  }
  return true;
}

}  // namespace pectinate::detail
