// SPDX-License-Identifier: MIT
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "fields.hpp"
#include "pectinate/constraints.hpp"

/// Makers and checks of tracts.
namespace pectinate::test {

/// The barycentric coordinates of the foot of the perpendicular from a point to a triangle's plane.
inline detail::Vector barycentric(const SurfaceMesh& mesh, std::int32_t t, const detail::Vector& point) {
  const detail::Vector normal = detail::vector(mesh.triangle_normals()[t]);
  detail::Vector shares;
  for (int k = 0; k < 3; ++k) {
    const detail::Vector a = corner(mesh, t, k + 1), b = corner(mesh, t, k + 2);
    shares[k] = (b - a).cross(point - a).dot(normal) / (2 * mesh.triangle_areas()[t]);
  }
  return shares;
}

inline double longest_side_of(const SurfaceMesh& mesh, std::int32_t t) {
  double longest = 0;
  for (const auto e : mesh.triangle_edges()[t]) longest = std::max(longest, mesh.edge_lengths()[e]);
  return longest;
}

/// Is the point in the triangle, to 3e-9 of its longest side?
inline bool lies_in(const SurfaceMesh& mesh, std::int32_t t, const detail::Vector& point) {
  const double longest = longest_side_of(mesh, t), tolerance = 3e-9 * longest;
  const double height = (point - corner(mesh, t, 0)).dot(detail::vector(mesh.triangle_normals()[t]));
  const double least_height = 2 * mesh.triangle_areas()[t] / longest;
  return std::abs(height) < tolerance && barycentric(mesh, t, point).minCoeff() * least_height > -tolerance;
}

/// All that is true of every projected tract.
inline void check_projected(const SurfaceMesh& mesh, const ProjectedTract& tract) {
  const auto& [points, triangles, greatest_distance, greatest_detour] = tract;
  REQUIRE(!triangles.empty());
  REQUIRE(points.size() == triangles.size() + 1);
  CHECK(greatest_distance >= 0);
  CHECK(greatest_detour >= 1);
  for (std::size_t s = 0; s < triangles.size(); ++s) {
    const detail::Vector start = detail::vector(points[s]), end = detail::vector(points[s + 1]);
    CHECK(lies_in(mesh, triangles[s], start));
    CHECK(lies_in(mesh, triangles[s], end));
    CHECK((end - start).norm() > 0.5e-9 * longest_side_of(mesh, triangles[s]));
    if (s == 0 || triangles[s] == triangles[s - 1]) continue;
    const auto& here = mesh.triangles()[triangles[s]];
    const auto& before = mesh.triangles()[triangles[s - 1]];
    CHECK(std::find_first_of(here.begin(), here.end(), before.begin(), before.end()) != here.end());
  }
}

inline double length_of(const std::vector<Vec3>& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    length += (detail::vector(points[i]) - detail::vector(points[i - 1])).norm();
  }
  return length;
}

inline Tract tract(std::vector<Vec3> points, double weight = hard) {
  return {"", std::move(points), weight};
}

inline Tract backwards(Tract tract) {
  std::reverse(tract.points.begin(), tract.points.end());
  return tract;
}

/// The constraint of a triangle, which must have one.
inline TriangleConstraint constraint_of(const Constraints& constraints, std::int32_t triangle) {
  const auto found = std::find_if(constraints.triangles.begin(), constraints.triangles.end(),
                                  [=](const TriangleConstraint& c) { return c.triangle == triangle; });
  REQUIRE(found != constraints.triangles.end());
  return *found;
}

inline std::vector<std::int32_t> constrained_triangles(const Constraints& constraints) {
  std::vector<std::int32_t> triangles;
  for (const auto& constraint : constraints.triangles) triangles.push_back(constraint.triangle);
  return triangles;
}

/// A point of the surface drawn at random: at a vertex, on an edge, or inside a triangle.
inline detail::Vector random_place(const SurfaceMesh& mesh, Random& random) {
  const auto t = static_cast<std::int32_t>(random.below(mesh.triangle_count()));
  const auto kind = random.below(4);
  if (kind == 0) return corner(mesh, t, 0);
  const double u = kind == 1 ? 0 : random.unit(), v = random.unit();
  const bool outside = u + v > 1;
  const detail::Vector a = corner(mesh, t, 0), b = corner(mesh, t, 1), c = corner(mesh, t, 2);
  return a + (outside ? 1 - u : u) * (b - a) + (outside ? 1 - v : v) * (c - a);
}

/// The flat ring between the radii 1 and 2.
inline Soup ring(int around, int rows) {
  return mapped(cylinder(around, rows, 1, 1),
                [](const detail::Vector& v) { return detail::Vector((1 + v.z()) * v.x(), (1 + v.z()) * v.y(), 0); });
}

/// All that is true of constraints.
inline void check_constraints(const SurfaceMesh& mesh, const Constraints& constraints) {
  std::int32_t last = -1;
  for (const auto& [triangle, direction, weight, tract] : constraints.triangles) {
    CHECK(triangle > last);
    last = triangle;
    CHECK(std::abs(detail::vector(direction).norm() - 1) < 1e-14);
    CHECK(std::abs(detail::vector(direction).dot(detail::vector(mesh.triangle_normals()[triangle]))) < 1e-13);
    CHECK(weight > 0);
    CHECK(tract >= -1);
  }
  CHECK(std::is_sorted(constraints.conflicts.begin(), constraints.conflicts.end(),
                       [](const auto& a, const auto& b) { return a.triangle < b.triangle; }));
}

}  // namespace pectinate::test
