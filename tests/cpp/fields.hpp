// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "meshes.hpp"
#include "pectinate/orientation_field.hpp"

/// Makers of orientation fields.
namespace pectinate::test {

inline detail::Vector corner(const SurfaceMesh& mesh, std::int32_t t, int k) {
  return detail::vector(mesh.vertices()[mesh.triangles()[t][k % 3]]);
}

inline detail::Vector centre(const SurfaceMesh& mesh, std::int32_t t) {
  return (corner(mesh, t, 0) + corner(mesh, t, 1) + corner(mesh, t, 2)) / 3;
}

/// One row per INPUT triangle: `function(centre, normal)` of the mesh triangle, zero for dropped ones.
template <class Function>
std::vector<Vec3> triangle_vectors(const SurfaceMesh& mesh, const Function& function) {
  std::vector<Vec3> vectors(mesh.input_triangle_count(), Vec3{0, 0, 0});
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    const detail::Vector normal = detail::vector(mesh.triangle_normals()[t]);
    vectors[mesh.input_triangle()[t]] = detail::vec3(function(centre(mesh, t), normal));
  }
  return vectors;
}

template <class Function>
OrientationField field_of(const SurfaceMesh& mesh, const Function& function) {
  return OrientationField::from_triangle_vectors(mesh, triangle_vectors(mesh, function));
}

inline OrientationField constant_field(const SurfaceMesh& mesh, const detail::Vector& direction) {
  return field_of(mesh, [&](const auto&, const auto&) { return direction; });
}

/// Turns slowly from place to place.
inline OrientationField smooth_field(const SurfaceMesh& mesh) {
  return field_of(mesh, [](const detail::Vector& c, const detail::Vector& normal) -> detail::Vector {
    const detail::Vector axis(std::sin(0.31 * c.y() + 0.2), std::cos(0.23 * c.x() + 0.1), 0.4 * std::sin(0.3 * c.z()));
    return axis - axis.dot(normal) * normal;
  });
}

/// Has nothing to do from one triangle with the next.
inline OrientationField random_field(const SurfaceMesh& mesh, std::uint64_t seed) {
  Random random(seed);
  const auto draw = [&] { return 2 * random.unit() - 1; };
  return field_of(mesh, [&](const auto&, const auto&) {
    const double x = draw(), y = draw(), z = draw();
    return detail::Vector(x, y, z);
  });
}

/// Some rotation, no axis of which is special.
inline Eigen::Matrix3d some_rotation() {
  return Eigen::AngleAxisd(1.234, detail::Vector(0.3, -0.5, 0.7).normalized()).toRotationMatrix();
}

/// The angle between two lines, radians.
inline double line_angle(const detail::Vector& a, const detail::Vector& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

}  // namespace pectinate::test
