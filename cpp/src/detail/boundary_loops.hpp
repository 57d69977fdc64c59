// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "detail/fans.hpp"
#include "detail/scratch.hpp"
#include "pectinate/surface_mesh.hpp"

namespace pectinate::detail {

/// The closed borders of a surface in which every vertex has one fan, longest first. Each starts at its smallest
/// vertex and runs as its first triangle's side does. `border_triangles` has all triangles with such a side, in
/// ascending order; others do no harm.
std::vector<BoundaryLoop> find_boundary_loops(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                              const Neighbours& neighbours,
                                              const std::vector<std::int32_t>& border_triangles,
                                              const std::vector<std::int32_t>& triangle_components, Scratch& scratch);

}  // namespace pectinate::detail
