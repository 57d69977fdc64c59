// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pectinate/surface_mesh.hpp"

namespace pectinate {

/// Why a triangle has a direction, or has none.
enum class DirectionStatus : std::uint8_t {
  valid,
  zero,        ///< the vector (or tensor) is zero
  non_finite,  ///< it has a NaN or an infinite component
  normal,      ///< it stands perpendicular to the triangle: nothing is left in the plane
  isotropic,   ///< the tensor, or the average over the corners, prefers no direction in the plane
};

/// A symmetric 3 x 3 tensor: xx, yy, zz, xy, yz, xz (the order of VTK).
using SymmetricTensor = std::array<double, 6>;

/// A line without a sign in every triangle of a mesh, or none where the input gives none (paper section 2.1).
///
/// Input arrays follow the INPUT triangles or vertices of the mesh, dropped ones included. Directions are projected
/// onto their triangle and normalised; reversing any input vector changes nothing at all. Zero, non-finite and normal
/// vectors are data: their triangles get no direction and streamlines end there.
class OrientationField {
 public:
  /// Each of these throws InvalidField for a wrong count or when no triangle gets a direction.
  static OrientationField from_triangle_vectors(const SurfaceMesh& mesh, std::span<const Vec3> vectors);
  /// Corner vectors are averaged as lines: the principal direction of the sum of v v^T / |v|^2 in the plane.
  static OrientationField from_vertex_vectors(const SurfaceMesh& mesh, std::span<const Vec3> vectors);
  static OrientationField from_triangle_tensors(const SurfaceMesh& mesh, std::span<const SymmetricTensor> tensors);
  static OrientationField from_vertex_tensors(const SurfaceMesh& mesh, std::span<const SymmetricTensor> tensors);

  /// Per mesh triangle: unit vector in its plane, zero where there is none; signed by the triangle's own sides.
  const std::vector<Vec3>& directions() const { return directions_; }
  const std::vector<DirectionStatus>& status() const { return status_; }
  bool has_direction(std::int32_t triangle) const { return status_[triangle] == DirectionStatus::valid; }
  std::size_t count(DirectionStatus status) const;
  /// Per mesh triangle, radians in [0, pi/2]: how far the input vector stood out of the plane (0 for tensors, for
  /// averages and where there is no direction). The normal part is dropped (paper section 4).
  const std::vector<double>& out_of_plane_angles() const { return out_of_plane_angles_; }

 private:
  friend class FieldInterpolator;
  /// Unchecked: unit vectors in their planes per MESH triangle, or zero where there is none. Their signs are free.
  static OrientationField from_planar_units(const SurfaceMesh& mesh, std::vector<Vec3> directions);
  OrientationField(std::vector<Vec3> directions, std::vector<DirectionStatus> status,
                   std::vector<double> out_of_plane_angles);

  std::vector<Vec3> directions_;
  std::vector<DirectionStatus> status_;
  std::vector<double> out_of_plane_angles_;
};

}  // namespace pectinate
