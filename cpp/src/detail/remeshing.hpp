// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "detail/implicit_surface.hpp"
#include "detail/isosurface.hpp"
#include "pectinate/types.hpp"

namespace pectinate::detail {

/// A triangulated implicit surface with its openings.
struct CutTriangles {
  IndexedTriangles surface;                      ///< counter-clockwise seen from outside
  std::vector<std::vector<std::int32_t>> loops;  ///< per cut, border vertices in order, the surface on their left
};

/// Cuts the closed triangulation and remeshes it until edges are near `edge_length` and triangles nearly equilateral
/// (Botsch and Kobbelt 2004). Every vertex ends on the surface, every border vertex on its cut's plane as well.
/// Throws SolverFailure where a cut leaves no border.
CutTriangles remesh(const IndexedTriangles& closed, const ImplicitSurface& surface, double edge_length);

/// One triangle becomes four; the new vertices are put on the surface and its borders.
CutTriangles subdivide(const CutTriangles& coarse, const ImplicitSurface& surface);

}  // namespace pectinate::detail
