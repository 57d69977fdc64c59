// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "detail/vec.hpp"
#include "pectinate/surface_mesh.hpp"

namespace pectinate::detail {

/// Counted round, so that corner 3 is corner 0.
inline Vector corner(const SurfaceMesh& mesh, std::int32_t triangle, int k) {
  return vector(mesh.vertices()[mesh.triangles()[triangle][k % 3]]);
}

inline std::array<Vector, 3> corners(const SurfaceMesh& mesh, std::int32_t triangle) {
  const auto& [a, b, c] = mesh.triangles()[triangle];
  return {vector(mesh.vertices()[a]), vector(mesh.vertices()[b]), vector(mesh.vertices()[c])};
}

inline double longest_side(const SurfaceMesh& mesh, std::int32_t triangle) {
  const auto& [a, b, c] = mesh.triangle_edges()[triangle];
  return std::max({mesh.edge_lengths()[a], mesh.edge_lengths()[b], mesh.edge_lengths()[c]});
}

}  // namespace pectinate::detail
