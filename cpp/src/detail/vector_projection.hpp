// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "pectinate/orientation_field.hpp"

namespace pectinate::detail {

/// Below this share of the input nothing meaningful is left in the plane.
inline constexpr double least_share = 1e-9;

/// A line, or none, in every triangle of a mesh.
struct PlanarDirections {
  std::vector<Vec3> units;
  std::vector<DirectionStatus> status;
  std::vector<double> out_of_plane_angles;
};

/// The projections on the mesh's triangles of vectors given per triangle of its input.
PlanarDirections project_vectors(const SurfaceMesh& mesh, std::span<const Vec3> vectors);

}  // namespace pectinate::detail
