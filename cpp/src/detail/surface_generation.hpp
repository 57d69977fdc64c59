// SPDX-License-Identifier: MIT
#pragma once

#include "detail/implicit_surface.hpp"
#include "detail/remeshing.hpp"

namespace pectinate::detail {

/// Whether narrow triangles are looked after once more.
enum class Finish { remeshed, opened_angles };

/// Nearly equilateral triangles of the edge length on the surface, cut open. The same bytes every time.
CutTriangles triangulate(const ImplicitSurface& surface, double edge_length, Finish finish);

}  // namespace pectinate::detail
