// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pectinate/orientation_field.hpp"
#include "pectinate/parameterization.hpp"

namespace pectinate {

struct ReferenceFrameOptions {
  /// Index into `mesh.boundary_loops()` of the inner loop, where u = 0 (paper: the fossa ovalis).
  std::optional<std::int32_t> inner_loop = std::nullopt;
  /// Where there is no such loop: u = 0 at the mapped vertex nearest to this point. At most one of the two is given.
  std::optional<Vec3> inner_point = std::nullopt;
};

/// A vertex at which the gradient of a function vanishes.
struct CriticalPoint {
  std::int32_t vertex;
  std::int32_t index;  ///< 1: an extremum, -1 and below: saddles
};

/// A reference field v_0 that vanishes nowhere, and the local basis that goes with it (paper section 2.2).
struct ReferenceFrame {
  std::vector<double> u;           ///< per mesh vertex: u_D in [0, 1]; NaN on fragments
  std::vector<Vec3> longitudinal;  ///< e_l per mesh triangle: the unit gradient of u on the surface
  std::vector<Vec3> transverse;    ///< e_t = n x e_l
  /// Triangles on which u is constant, such as those with all corners on one loop: they have the frame of a neighbour,
  /// turned into their plane about the common edge. Fragments too: there it starts from a triangle's first side.
  std::vector<std::int32_t> borrowed_triangles;
  /// Interior vertices at which u has a critical point, by the sign changes around their link; holes are taken as
  /// filled and vertices where u is imposed are left out. Empty for a usable frame.
  std::vector<CriticalPoint> critical_points;
};

/// Solves Laplace's equation on the disk, u = 1 on the circle and 0 on the inner loop or point, with positive mean
/// value weights. With neither, u = (1 + x) / 2 of the disk, whose gradient cannot vanish.
/// Throws InvalidOption for a parameterization of another mesh; for a loop that does not exist, is the outer one or
/// bounds a fragment; for a point that is not finite or nearest to the outer loop; if both are given. SolverFailure.
ReferenceFrame make_reference_frame(const SurfaceMesh& mesh, const Parameterization& parameterization,
                                    const ReferenceFrameOptions& options = {});

/// Equation (1): the angle of the field in the frame, per mesh triangle, radians in (-pi/2, pi/2]; NaN where the field
/// has no direction. Throws InvalidField for a field on another number of triangles.
std::vector<double> field_angles(const ReferenceFrame& frame, const OrientationField& field);

/// Equation (2): the field that has given angles (per mesh triangle, radians, any branch; NaN: no direction).
/// Throws InvalidField for a wrong count or when no angle is finite.
OrientationField field_from_angles(const SurfaceMesh& mesh, const ReferenceFrame& frame,
                                   const std::vector<double>& angles);

}  // namespace pectinate
