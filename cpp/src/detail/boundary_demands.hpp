// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "detail/demands.hpp"

namespace pectinate::detail {

/// The sides of a boundary loop: entry i joins its vertices i and i + 1 and is numbered 3 triangle + side.
using LoopSides = std::vector<std::int32_t>;

/// Of every boundary loop of the mesh.
std::vector<LoopSides> find_loop_sides(const SurfaceMesh& mesh);

/// What a condition asks of the triangles along its loop, one demand each; none of a triangle with three sides on it.
std::vector<Demand> boundary_demands(const SurfaceMesh& mesh, const BoundaryLoop& loop, const LoopSides& sides,
                                     const BoundaryCondition& condition);

}  // namespace pectinate::detail
