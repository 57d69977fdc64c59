// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pectinate/orientation_field.hpp"

namespace pectinate {

/// A vertex around which an orientation field turns against the surface.
struct Singularity {
  std::int32_t vertex;      ///< of the mesh, not on its border
  std::int32_t half_turns;  ///< twice the index: 1 where lines bend round a point, -1 for a triradius, 2 for a vortex
  Vec3 position;
};

/// Where a field is singular, and how it turns along the boundary loops. On every orientable component, all of whose
/// triangles have a direction, the half turns of singularities and loops add up to twice the Euler characteristic.
struct FieldTopology {
  std::vector<Singularity> singularities;  ///< ascending by vertex
  /// Per boundary loop, the half turns of its tangent against the field, the surface on the left; 0 for fibres parallel
  /// or perpendicular to it. None where a triangle along the loop has no direction.
  std::vector<std::optional<std::int32_t>> loop_half_turns;
};

/// Counts by the angles between neighbouring triangles, each taken as the least turn in the unfolded surface. Vertices
/// with a triangle without direction are left out.
FieldTopology field_topology(const SurfaceMesh& mesh, const OrientationField& field);

/// How much a field varies: half the sum over inner edges of |z - z of the neighbour, carried over|^2 times the edge's
/// length over the distance of the circumcentres, z = exp(2 i theta). No unit; independent of scale. Edges at triangles
/// without a direction are left out.
double dirichlet_energy(const SurfaceMesh& mesh, const OrientationField& field);

}  // namespace pectinate
