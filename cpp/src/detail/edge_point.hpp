// SPDX-License-Identifier: MIT
#pragma once

#include "detail/crossings.hpp"
#include "detail/vec.hpp"
#include "pectinate/surface_mesh.hpp"
#include "pectinate/tracing.hpp"

namespace pectinate::detail {

/// Where an edge point lies in space.
inline Vector position(const SurfaceMesh& mesh, const EdgePoint& point) {
  const auto [a, b] = mesh.edges()[point.edge];
  return (1 - point.position) * vector(mesh.vertices()[a]) + point.position * vector(mesh.vertices()[b]);
}

}  // namespace pectinate::detail
