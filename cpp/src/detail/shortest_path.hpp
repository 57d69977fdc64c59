// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include "detail/surface_curve.hpp"

namespace pectinate::detail {

/// A locally shortest path over the surface between places in two triangles of one component: the shortest one in the
/// strip of triangles that a nearly shortest path through midpoints of edges crosses.
std::vector<CurvePiece> shortest_path(const SurfaceMesh& mesh, const Place& a, const Place& b);

/// The same, if the path through midpoints is not longer than `limit`.
std::optional<std::vector<CurvePiece>> path_within(const SurfaceMesh& mesh, const Place& a, const Place& b,
                                                   double limit);

}  // namespace pectinate::detail
