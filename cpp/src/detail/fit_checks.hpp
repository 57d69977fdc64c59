// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "pectinate/errors.hpp"
#include "pectinate/orientation_field.hpp"
#include "pectinate/parameterization.hpp"

namespace pectinate::detail {

/// Throws InvalidField for a field on another number of triangles.
inline void check_is_on(const SurfaceMesh& mesh, const OrientationField& field) {
  if (field.directions().size() == mesh.triangle_count()) return;
  throw InvalidField("the field has " + std::to_string(field.directions().size()) + " directions, but the mesh has " +
                     std::to_string(mesh.triangle_count()) + " triangles; give the field that was made for this mesh");
}

/// Whether a parameterization has the vertices and loops of a mesh.
inline bool is_of(const Parameterization& parameterization, const SurfaceMesh& mesh) {
  const std::size_t loop_count = mesh.boundary_loops().size();
  return parameterization.points.size() == mesh.vertices().size() &&
         parameterization.loop_centres.size() == loop_count && parameterization.outer_loop >= 0 &&
         static_cast<std::size_t>(parameterization.outer_loop) < loop_count;
}

}  // namespace pectinate::detail
