// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "detail/vec.hpp"
#include "pectinate/surface_mesh.hpp"
#include "pectinate/tracing.hpp"

namespace pectinate::detail {

/// Crossings keep this share of the edge away from its ends: a streamline never hits a vertex.
inline constexpr double least_position = 1e-9;

inline double clamp_position(double position) {
  return std::clamp(position, least_position, 1 - least_position);
}

inline Vector position(const SurfaceMesh& mesh, const EdgePoint& point) {
  const auto [a, b] = mesh.edges()[point.edge];
  return (1 - point.position) * vector(mesh.vertices()[a]) + point.position * vector(mesh.vertices()[b]);
}

}  // namespace pectinate::detail
