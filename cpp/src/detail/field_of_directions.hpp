// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "pectinate/orientation_field.hpp"

namespace pectinate::detail {

/// The field of vectors per MESH triangle; zero and non-finite ones give no direction.
inline OrientationField field_of_directions(const SurfaceMesh& mesh, std::span<const Vec3> directions) {
  std::vector<Vec3> of_input(mesh.input_triangle_count(), Vec3{0, 0, 0});
  for (std::size_t t = 0; t < directions.size(); ++t) of_input[mesh.input_triangle()[t]] = directions[t];
  return OrientationField::from_triangle_vectors(mesh, of_input);
}

}  // namespace pectinate::detail
