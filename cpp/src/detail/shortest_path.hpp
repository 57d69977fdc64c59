// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "detail/surface_curve.hpp"

namespace pectinate::detail {

/// A locally shortest path over the surface between places in two triangles of one component: the shortest one in the
/// strip of triangles that the shortest path through midpoints of edges crosses.
std::vector<CurvePiece> shortest_path(const SurfaceMesh& mesh, const Place& a, const Place& b);

}  // namespace pectinate::detail
