// SPDX-License-Identifier: MIT
#include "detail/surface_generation.hpp"

#include <cmath>

#include "detail/angle_opening.hpp"
#include "detail/isosurface.hpp"

namespace pectinate::detail {

namespace {

/// Shorter edges are made by subdivision of triangles at least this large, which is many times faster.
constexpr double shortest_remeshed_edge = 0.8;

}  // namespace

CutTriangles triangulate(const ImplicitSurface& surface, double edge_length, Finish finish) {
  int subdivisions = 0;
  while (std::ldexp(edge_length, subdivisions) < shortest_remeshed_edge) ++subdivisions;
  const double coarse = std::ldexp(edge_length, subdivisions);
  auto triangles = remesh(extract_isosurface(surface, coarse), surface, coarse);
  if (finish == Finish::opened_angles) open_angles(triangles, surface, coarse);
  for (int i = 0; i < subdivisions; ++i) triangles = subdivide(triangles, surface);
  return triangles;
}

}  // namespace pectinate::detail
