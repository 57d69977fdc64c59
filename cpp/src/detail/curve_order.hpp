// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "detail/scratch.hpp"
#include "pectinate/types.hpp"

namespace pectinate::detail {

/// Numbers points along a space-filling curve, so that near ones lie near each other in memory. For speed only: the
/// numbers depend on the axes.
std::vector<std::int32_t> curve_ranks(std::span<const Vec3> points, Scratch& scratch);

/// Numbers triangles by the least rank among their corners.
std::vector<std::int32_t> ranks_by_corner(std::span<const Triangle> triangles,
                                          const std::vector<std::int32_t>& vertex_ranks, Scratch& scratch);

}  // namespace pectinate::detail
