// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pectinate/surface_mesh.hpp"

namespace pectinate::detail {

/// What is valid in a triangle soup, compact, in input order, with the maps back.
struct TriangleSoup {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> input_vertex, input_triangle;
  MeshRepairs repairs;  ///< what was dropped
};

/// Drops triangles with non-finite corners, degenerate ones and exact repetitions, then vertices that nothing uses.
/// Throws InvalidMesh for an index out of range or when nothing is left.
TriangleSoup clean_triangle_soup(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

}  // namespace pectinate::detail
