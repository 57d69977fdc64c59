// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "detail/implicit_surface.hpp"
#include "pectinate/types.hpp"

namespace pectinate::detail {

struct IndexedTriangles {
  std::vector<Vector> vertices;
  std::vector<Triangle> triangles;
};

/// The zero set of the surface's function within its bounds, cuts ignored, by marching tetrahedra on a grid of cubes: a
/// manifold, closed if the bounds hold all of it, counter-clockwise seen from outside, of ragged triangles. Features
/// thinner than `cell_size` may be lost.
IndexedTriangles extract_isosurface(const ImplicitSurface& surface, double cell_size);

}  // namespace pectinate::detail
