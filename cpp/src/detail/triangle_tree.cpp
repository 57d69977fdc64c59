// SPDX-License-Identifier: MIT
#include "detail/triangle_tree.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <utility>

#include "detail/mesh_geometry.hpp"

namespace pectinate::detail {
namespace {

constexpr std::size_t leaf_size = 4;
/// A box is left out only if it is farther than this times the best: rounding must not part equally near triangles.
constexpr double slack = 1 + 1e-12;

/// A foot as near to a side as this is taken from the side: both its triangles then find the same point.
constexpr double side_share = 1e-13;

Vector nearest_on_side(const Vector& point, Vector a, Vector b) {
  if (std::lexicographical_compare(b.begin(), b.end(), a.begin(), a.end())) std::swap(a, b);
  const Vector side = b - a;
  const double along = side.dot(point - a) / side.squaredNorm();
  if (!(along > 0)) return a;
  if (along >= 1) return b;
  return a + along * side;
}

}  // namespace

Vector nearest_in_triangle(const Vector& point, const std::array<Vector, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vector normal = (b - a).cross(c - a);
  // Barycentric coordinates of the foot of the perpendicular, times the same factor.
  const double to_a = normal.dot((c - b).cross(point - b));
  const double to_b = normal.dot((a - c).cross(point - c));
  const double to_c = normal.dot((b - a).cross(point - a));
  const double total = to_a + to_b + to_c;
  if (std::min({to_a, to_b, to_c}) > side_share * total) return (to_a * a + to_b * b + to_c * c) / total;
  Vector best = nearest_on_side(point, a, b);
  for (const Vector& other : {nearest_on_side(point, b, c), nearest_on_side(point, c, a)}) {
    if ((other - point).squaredNorm() < (best - point).squaredNorm()) best = other;
  }
  return best;
}

TriangleTree::TriangleTree(const SurfaceMesh& mesh) : mesh_(mesh) {
  const std::size_t count = mesh.triangle_count();
  std::vector<Item> items(count);
  for (std::size_t t = 0; t < count; ++t) {
    const auto [a, b, c] = corners(mesh, static_cast<std::int32_t>(t));
    const Vector centre = (a + b + c) / 3;
    for (int k = 0; k < 3; ++k) items[t].centre[k] = static_cast<float>(centre[k]);
    items[t].triangle = static_cast<std::int32_t>(t);
  }
  nodes_.reserve(count + 1);
  triangles_.reserve(count);
  add_node(items, 0);
}

void TriangleTree::add_node(std::span<Item> items, std::int32_t first) {
  const auto index = nodes_.size();
  nodes_.push_back({Vector::Zero(), Vector::Zero(), -1, first, static_cast<std::int32_t>(items.size())});
  if (items.size() <= leaf_size) {
    Vector low = Vector::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const auto& item : items) {
      triangles_.push_back(item.triangle);
      for (const auto& corner : corners(mesh_, item.triangle)) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
      }
    }
    nodes_[index].low = low;
    nodes_[index].high = high;
    return;
  }
  auto low = items[0].centre, high = low;
  for (const auto& item : items) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], item.centre[k]);
      high[k] = std::max(high[k], item.centre[k]);
    }
  }
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
  }
  const std::size_t half = items.size() / 2;
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                   [axis](const Item& a, const Item& b) { return a.centre[axis] < b.centre[axis]; });
  add_node(items.first(half), first);
  nodes_[index].second_child = static_cast<std::int32_t>(nodes_.size());
  add_node(items.subspan(half), first + static_cast<std::int32_t>(half));
  const auto &one = nodes_[index + 1], &other = nodes_[nodes_[index].second_child];
  nodes_[index].low = one.low.cwiseMin(other.low);
  nodes_[index].high = one.high.cwiseMax(other.high);
}

void TriangleTree::visit_leaf(const Node& leaf, const Vector& point, SurfacePoint& best, double& least_square) const {
  for (std::int32_t i = leaf.first_triangle; i < leaf.first_triangle + leaf.triangle_count; ++i) {
    const Vector nearest = nearest_in_triangle(point, corners(mesh_, triangles_[i]));
    const double square = (nearest - point).squaredNorm();
    if (square < least_square || (square == least_square && triangles_[i] < best.triangle)) {
      best = {triangles_[i], vec3(nearest), 0};
      least_square = square;
    }
  }
}

SurfacePoint TriangleTree::nearest(const Vector& point) const {
  SurfacePoint best{0, {}, 0};
  double least_square = std::numeric_limits<double>::infinity();
  std::vector<std::pair<std::int32_t, double>> open;  // nodes, with the squared distances of their boxes
  open.reserve(64);
  open.emplace_back(0, nodes_[0].offset(point).squaredNorm());
  while (!open.empty()) {
    const auto [index, box_square] = open.back();
    open.pop_back();
    if (box_square > least_square * slack) continue;
    const Node& node = nodes_[index];
    if (node.second_child < 0) {
      visit_leaf(node, point, best, least_square);
      continue;
    }
    std::pair near(index + 1, nodes_[index + 1].offset(point).squaredNorm());
    std::pair far(node.second_child, nodes_[node.second_child].offset(point).squaredNorm());
    if (far.second < near.second) std::swap(near, far);
    open.push_back(far);
    open.push_back(near);
  }
  best.distance = std::sqrt(least_square);
  return best;
}

}  // namespace pectinate::detail
