// SPDX-License-Identifier: MIT
#include "detail/disk_locator.hpp"

#include <algorithm>
#include <limits>

namespace pectinate::detail {
namespace {

using Box = Eigen::AlignedBox<double, 2>;

/// How far rounding moves a point of the unit disk. An absolute length: triangles can be as small as 1e-9.
constexpr double rounding = 1e-15;

struct PointSearch {
  const Eigen::Vector2d& point;
  const DiskTriangle* best = nullptr;
  double greatest_depth = -rounding;

  bool intersectVolume(const Box& box) const {  // NOLINT(readability-identifier-naming): Eigen calls it
    return box.squaredExteriorDistance(point) <= rounding * rounding;
  }
  bool intersectObject(const DiskTriangle& triangle) {  // NOLINT(readability-identifier-naming)
    double depth = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const auto &from = triangle.corners[k], &to = triangle.corners[(k + 1) % 3];
      depth = std::min(depth, cross(to - from, point - from) / (to - from).norm());
    }
    const bool is_better =
        best != nullptr && depth == greatest_depth ? triangle.index < best->index : depth >= greatest_depth;
    if (is_better) {
      best = &triangle;
      greatest_depth = depth;
    }
    return false;  // go on
  }
};

/// Found by Eigen's tree.
Box bounding_box(const DiskTriangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  return Box(a).extend(b).extend(c);
}

std::array<double, 3> barycentric(const DiskTriangle& triangle, const Eigen::Vector2d& point) {
  const auto& [a, b, c] = triangle.corners;
  std::array weights{cross(c - b, point - b), cross(a - c, point - c), cross(b - a, point - a)};
  for (auto& weight : weights) weight = std::max(weight, 0.0);
  const double total = weights[0] + weights[1] + weights[2];
  for (auto& weight : weights) weight /= total;
  return weights;
}

std::vector<DiskTriangle> disk_triangles(const SurfaceMesh& mesh, const std::vector<DiskPoint>& points) {
  std::vector<DiskTriangle> triangles;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto triangle = disk_triangle(mesh, points, static_cast<std::int32_t>(t));
    if (triangle) triangles.push_back(*triangle);
  }
  return triangles;
}

}  // namespace

std::optional<DiskTriangle> disk_triangle(const SurfaceMesh& mesh, const std::vector<DiskPoint>& points,
                                          std::int32_t triangle) {
  DiskTriangle result{{}, triangle};
  for (int k = 0; k < 3; ++k) {
    const auto& [x, y] = points[mesh.triangles()[triangle][k]];
    result.corners[k] = {x, y};
  }
  const auto& [a, b, c] = result.corners;
  if (!(cross(b - a, c - a) > 0)) return {};
  return result;
}

DiskLocator::DiskLocator(const SurfaceMesh& mesh, const std::vector<DiskPoint>& points) {
  const auto triangles = disk_triangles(mesh, points);
  is_empty_ = triangles.empty();
  std::vector<Box> boxes;
  boxes.reserve(triangles.size());
  for (const auto& triangle : triangles) boxes.push_back(bounding_box(triangle));
  tree_.init(triangles.begin(), triangles.end(), boxes.begin(), boxes.end());
}

std::optional<DiskPlace> DiskLocator::find(const Eigen::Vector2d& point) const {
  if (is_empty_) return {};
  PointSearch search{point};
  Eigen::BVIntersect(tree_, search);
  if (search.best == nullptr) return {};
  return DiskPlace{search.best->index, barycentric(*search.best, point)};
}

}  // namespace pectinate::detail
