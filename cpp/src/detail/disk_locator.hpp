// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <unsupported/Eigen/BVH>
#include <vector>

#include "pectinate/parameterization.hpp"

namespace pectinate::detail {

/// A point inside a triangle of the disk, by its barycentric coordinates.
struct DiskPlace {
  std::int32_t triangle;
  std::array<double, 3> weights;  ///< not negative; their sum is 1
};

/// A triangle of the disk, counter-clockwise.
struct DiskTriangle {
  std::array<Eigen::Vector2d, 3> corners;
  std::int32_t index;
};

/// Twice the area that two vectors span, signed.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The image of a triangle; none where it has no place in the disk, or is flat or flipped there.
std::optional<DiskTriangle> disk_triangle(const SurfaceMesh& mesh, const std::vector<DiskPoint>& points,
                                          std::int32_t triangle);

/// Finds the triangle at a point of the disk.
class DiskLocator {
 public:
  DiskLocator(const SurfaceMesh& mesh, const std::vector<DiskPoint>& points);

  /// Of triangles that hold the point (finite), up to rounding, the one that it is deepest in; of equals the first.
  std::optional<DiskPlace> find(const Eigen::Vector2d& point) const;

 private:
  bool is_empty_;  // which Eigen's tree does not allow for
  Eigen::KdBVH<double, 2, DiskTriangle> tree_;
};

}  // namespace pectinate::detail
