// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "detail/triangle_soup.hpp"

namespace pectinate::detail {

/// How the triangles of a soup hang together: geometric edges, and which sides are joined into a surface.
struct Topology {
  std::vector<std::array<std::int32_t, 2>> edges;  ///< soup vertices, the smaller first
  std::vector<std::array<std::int32_t, 3>> triangle_edges;
  std::vector<std::int32_t> edge_offsets, edge_triangles;
  std::vector<std::array<SideNeighbour, 3>> neighbours;
  /// Per triangle, a bit for each side: it runs from the first end of its edge to the second; it runs the same way
  /// round as the side that it is joined to, so that one of the two triangles must be reversed.
  std::vector<std::uint8_t> side_runs_along, side_runs_alike;
  std::vector<std::int32_t> cut_edges;  ///< edges with more than two triangles
};

/// Joins the sides of every edge that has two triangles. Edges with more are cut open, except for two triangles that
/// stay joined through fans at both ends: a slit whose lips share both end vertices would be no surface.
Topology make_topology(const TriangleSoup& soup);

/// Gives every fan of triangles its own copy of its vertex: the first keeps the index, copies go to the end.
/// Records them in `soup.repairs.split_vertices`.
TriangleSoup split_vertices(TriangleSoup soup, const Topology& topology);

}  // namespace pectinate::detail
