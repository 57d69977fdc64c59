// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "detail/vec.hpp"
#include "pectinate/constraints.hpp"
#include "pectinate/surface_mesh.hpp"

namespace pectinate::detail {

/// The point of a triangle nearest to `point`. Points on a side come out the same, bit for bit, from both its
/// triangles.
Vector nearest_in_triangle(const Vector& point, const std::array<Vector, 3>& corners);

/// Finds nearest points of a surface by a hierarchy of boxes around its triangles. The mesh must outlive it.
class TriangleTree {
 public:
  explicit TriangleTree(const SurfaceMesh& mesh);

  /// Of equally near triangles the first. `point` is finite and within reach.
  SurfacePoint nearest(const Vector& point) const;

  /// To the box around all triangles; no finite point is too far away for it.
  double box_distance(const Vector& point) const { return nodes_[0].offset(point).stableNorm(); }
  /// Points farther from that box are equally near to all triangles as far as double precision can tell.
  double reach() const { return 1e9 * (nodes_[0].high - nodes_[0].low).norm(); }

 private:
  struct Item {
    std::array<float, 3> centre;  // good enough for dividing
    std::int32_t triangle;
  };
  /// The box of some triangles; its first child follows it.
  struct Node {
    Vector low, high;
    std::int32_t second_child;  // or -1 for a leaf
    std::int32_t first_triangle, triangle_count;
    Vector offset(const Vector& point) const { return (low - point).cwiseMax(point - high).cwiseMax(0); }
  };
  void add_node(std::span<Item> items, std::int32_t first);
  void visit_leaf(const Node& leaf, const Vector& point, SurfacePoint& best, double& least_square) const;

  const SurfaceMesh& mesh_;
  std::vector<Node> nodes_;
  std::vector<std::int32_t> triangles_;  // leaf after leaf
};

}  // namespace pectinate::detail
