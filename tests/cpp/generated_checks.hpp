// SPDX-License-Identifier: MIT
#pragma once

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "detail/vec.hpp"
#include "pectinate/demo_atrium.hpp"
#include "pectinate/surface_mesh.hpp"

/// What is true of every surface that the library makes itself.
namespace pectinate::test {

/// Of each triangle, in degrees, ascending.
template <typename Surface>
std::vector<double> least_angles(const Surface& surface) {
  std::vector<double> angles;
  for (const Triangle& triangle : surface.triangles) {
    double least = std::numbers::pi;
    for (int k = 0; k < 3; ++k) {
      const auto corner = [&](int i) { return detail::vector(surface.vertices[triangle[(k + i) % 3]]); };
      const detail::Vector a = corner(1) - corner(0), b = corner(2) - corner(0);
      least = std::min(least, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
    angles.push_back(least * 180 / std::numbers::pi);
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

/// One component without handles, wound as its triangles are, of good triangles about as long as asked.
template <typename Surface>
void check_good_surface(const Surface& surface, std::size_t loop_count, double edge_length) {
  const SurfaceMesh mesh(surface.vertices, surface.triangles);
  REQUIRE(mesh.components().size() == 1);
  CHECK(mesh.triangle_count() == surface.triangles.size());
  CHECK(mesh.vertices().size() == surface.vertices.size());
  CHECK(mesh.components()[0].euler_characteristic == 2 - static_cast<int>(loop_count));
  CHECK(mesh.components()[0].genus == 0);
  CHECK(mesh.boundary_loops().size() == loop_count);
  CHECK(mesh.repairs().reversed_triangles.empty());
  CHECK(mesh.repairs().split_vertices.empty());
  const auto angles = least_angles(surface);
  CHECK(angles.front() > 15);
  CHECK(angles[angles.size() / 100] > 35);
  double sum = 0;
  for (const double length : mesh.edge_lengths()) sum += length;
  CHECK(sum / static_cast<double>(mesh.edge_lengths().size()) == doctest::Approx(edge_length).epsilon(0.05));
}

/// Consecutive vertices of the named loops are the open sides of the surface, which lies on their left.
template <typename Surface>
void check_loops_are_the_open_sides(const Surface& surface) {
  const SurfaceMesh mesh(surface.vertices, surface.triangles);
  std::vector<std::array<std::int32_t, 2>> open_sides, loop_sides;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    const auto& corners = surface.triangles[t];
    for (int k = 0; k < 3; ++k) {
      if (mesh.neighbour(t, k).triangle < 0) open_sides.push_back({corners[k], corners[(k + 1) % 3]});
    }
  }
  for (const auto& [name, vertices] : surface.loops) {
    for (std::size_t i = 0; i < vertices.size(); ++i)
      loop_sides.push_back({vertices[i], vertices[(i + 1) % vertices.size()]});
  }
  std::sort(open_sides.begin(), open_sides.end());
  std::sort(loop_sides.begin(), loop_sides.end());
  CHECK(loop_sides == open_sides);
}

}  // namespace pectinate::test
