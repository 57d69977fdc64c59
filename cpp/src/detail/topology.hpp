// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "detail/scratch.hpp"
#include "detail/triangle_soup.hpp"

namespace pectinate::detail {

/// An edge with more than two triangles, and those of their sides that are it: 4 triangle + side, in ascending order.
struct CutEdge {
  std::int32_t edge;
  std::vector<std::int32_t> sides;
};

/// How the triangles of a soup hang together: geometric edges, and which sides are joined into a surface.
struct Topology {
  std::vector<std::array<std::int32_t, 2>> edges;  ///< soup vertices, the smaller first
  std::vector<std::array<std::int32_t, 3>> triangle_edges;
  std::vector<std::int32_t> edge_sides;  ///< 4 triangle + side of an edge's first triangle; where it was cut, ~ its
                                         ///< number in cut_edges
  std::vector<CutEdge> cut_edges;
  std::vector<std::array<PackedNeighbour, 3>> neighbours;
  std::vector<std::int32_t> border_triangles;  ///< in ascending order: all with a side that no other is
                                               ///< joined to, and after `rejoin_slits` some more
};

/// How many edges there are, at most, on nearly every surface: half the sides, those at borders and cuts once more.
inline std::size_t likely_edge_count(std::size_t vertex_count, std::size_t triangle_count) {
  return 3 * triangle_count / 2 + vertex_count / 8;
}

/// Joins the sides of every edge that has two triangles. Edges with more are cut open. Uses another topology's room.
Topology join_triangles(const TriangleSoup& soup, Topology room, Scratch& scratch);

/// What joining takes of it: more than what any other step of making a mesh does, if most vertices are used.
std::size_t scratch_size(std::size_t vertex_count, std::size_t triangle_count);

/// Every triangle that may have the same corners as another, in ascending order: such ones share all three edges.
std::vector<std::int32_t> likely_repetitions(const Topology& topology);

/// Joins two triangles of a cut edge that are connected through fans at both ends: a slit whose lips share both end
/// vertices would be no surface.
Topology rejoin_slits(Topology topology, const TriangleSoup& soup);

/// Gives every fan of triangles its own copy of its vertex: the first keeps the index, copies go to the end.
/// Records them in `soup.repairs.split_vertices`. Returns the vertices that were copied, in order.
struct SplitSoup {
  TriangleSoup soup;
  std::vector<std::int32_t> copied_vertices;
};
SplitSoup split_vertices(TriangleSoup soup, const Topology& topology, Scratch& scratch);

/// Swaps corners 1 and 2 of a triangle.
void reverse_triangle(std::int32_t t, std::vector<Triangle>& triangles, Topology& topology);

}  // namespace pectinate::detail
