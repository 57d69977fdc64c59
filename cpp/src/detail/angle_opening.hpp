// SPDX-License-Identifier: MIT
#pragma once

#include "detail/implicit_surface.hpp"
#include "detail/remeshing.hpp"

namespace pectinate::detail {

/// Moves vertices of narrow triangles along the surface and its borders, as long as that opens the smallest angle about
/// them.
void open_angles(CutTriangles& mesh, const ImplicitSurface& surface, double edge_length);

}  // namespace pectinate::detail
