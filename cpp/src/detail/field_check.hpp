// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "pectinate/errors.hpp"
#include "pectinate/orientation_field.hpp"

namespace pectinate::detail {

/// Throws InvalidField for a field on another number of triangles.
inline void check_is_on(const SurfaceMesh& mesh, const OrientationField& field) {
  if (field.directions().size() == mesh.triangle_count()) return;
  throw InvalidField("the field has " + std::to_string(field.directions().size()) + " directions, but the mesh has " +
                     std::to_string(mesh.triangle_count()) + " triangles; give the field that was made for this mesh");
}

}  // namespace pectinate::detail
