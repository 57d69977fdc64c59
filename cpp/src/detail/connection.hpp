// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "detail/vec.hpp"
#include "pectinate/surface_mesh.hpp"

namespace pectinate::detail {

/// A line in a triangle as exp(2 i angle), the angle from the triangle's first side to the left: sign-free.
using Phase = std::complex<double>;

/// The basis of a triangle's plane: along its first side, and to the left of that, seen against the normal.
struct TriangleFrame {
  Vector along, across;
};

TriangleFrame triangle_frame(const SurfaceMesh& mesh, std::int32_t triangle);

/// Of a direction in the triangle's plane, not zero.
Phase phase_of(const Vector& direction, const TriangleFrame& frame);
/// A unit vector along the line of a phase, not zero.
Vector direction_of(const Phase& phase, const TriangleFrame& frame);

/// Two neighbouring nodes. Carried from the first to the second by unfolding their triangles, z becomes transport z.
struct ConnectionEdge {
  std::int32_t first, second;
  Phase transport;  ///< unit
  double weight;    ///< length of the edge over the distance of the circumcentres, bounded
};

/// The Levi-Civita connection of lines between neighbouring triangles. Node t is triangle t. A triangle of a component
/// that is not orientable has a second node, its back, in the frame (along, -across), so that neighbours always agree
/// about left and right: there the nodes are the triangles of the orientation double cover. What is asked of a node is
/// asked, conjugated, of its back; then solutions agree as well.
struct Connection {
  std::vector<ConnectionEdge> edges;
  std::vector<std::int32_t> back;  ///< per triangle, its second node, or -1
  std::int32_t node_count;
};

Connection make_connection(const SurfaceMesh& mesh);

}  // namespace pectinate::detail
