// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "detail/crossings.hpp"
#include "detail/large_array.hpp"
#include "detail/vec.hpp"
#include "pectinate/orientation_field.hpp"
#include "pectinate/surface_mesh.hpp"

namespace pectinate::detail {

/// A triangle's corners, as numbers of vertices, and which of the mesh's triangles it is; never across cache lines.
struct alignas(16) SheetTriangle {
  std::int32_t low, middle, high, mesh_triangle;
};

/// A surface and its field as streamlines see them. Its triangles lie in memory along a space-filling curve: what is
/// near on the surface is near in the cache. Everything here is indexed by these triangles, not by the mesh's.
struct Sheet {
  std::vector<std::int32_t> ranks;  ///< per mesh triangle: the triangle here
  LargeArray<Vector> vertices;      ///< in an order of their own
  LargeArray<SheetTriangle> triangles;
  LargeArray<TriangleCrossings> crossings;
  double directed_area = 0;  ///< of the triangles with an orientation

  std::int32_t triangle_count() const { return static_cast<std::int32_t>(crossings.size()); }
  bool has_direction(std::int32_t triangle) const { return crossings[triangle].split > 0; }
  std::int32_t mesh_triangle(std::int32_t triangle) const { return triangles[triangle].mesh_triangle; }
  const Vector& low(std::int32_t triangle) const { return vertices[triangles[triangle].low]; }
  const Vector& middle(std::int32_t triangle) const { return vertices[triangles[triangle].middle]; }
  const Vector& high(std::int32_t triangle) const { return vertices[triangles[triangle].high]; }

  void prefetch_corners(std::int32_t triangle) const {
    for (const auto* corner : {&low(triangle), &middle(triangle), &high(triangle)}) __builtin_prefetch(corner);
  }

  /// Where a chord crosses a side.
  Vector point(std::int32_t triangle, Role role, double chord) const {
    const Vector& from = role == middle_high ? middle(triangle) : low(triangle);
    const Vector& to = role == low_middle ? middle(triangle) : high(triangle);
    return from + side_position(crossings[triangle], role, chord) * (to - from);
  }
};

/// Sides at which the field turns by more than `abrupt_turn_angle` stop streamlines.
Sheet make_sheet(const SurfaceMesh& mesh, const OrientationField& field, double abrupt_turn_angle);

}  // namespace pectinate::detail
