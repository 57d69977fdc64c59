// SPDX-License-Identifier: MIT
#include "detail/shortest_path.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <unordered_map>
#include <utility>

#include "detail/mesh_geometry.hpp"

namespace pectinate::detail {
namespace {

using Flat = Eigen::Vector2d;

/// The search counts the straight way ahead by this much more: it sees far less of the surface, and the path through
/// midpoints is at most as much longer.
constexpr double haste = 1.1;

double cross(const Flat& a, const Flat& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// A* over the sides that a path leaves triangles through, 3 t + k, joined by their midpoints.
class StripSearch {
 public:
  StripSearch(const SurfaceMesh& mesh, const Place& a, const Place& b) : mesh_(mesh), a_(a), b_(b) {}

  /// The sides that the path leaves triangles through, from `a` to `b`; none where all paths are longer than `limit`.
  std::vector<std::int32_t> run(double limit) {
    reach_sides(a_.triangle, -1, -1, a_.point, 0);
    while (!open_.empty()) {
      const auto [estimate, side] = open_.top();
      if (estimate > limit) break;
      open_.pop();
      if (side == goal) return sides_to(reached_.at(goal).previous);
      Reached& here = reached_.at(side);
      if (std::exchange(here.done, true)) continue;
      const double length = here.length;
      const Vector place = middle(side);
      const auto across = mesh_.neighbour(side / 3, side % 3);
      if (across.triangle == b_.triangle) reach(goal, side, length + (b_.point - place).norm(), 0);
      reach_sides(across.triangle, across.side, side, place, length);
    }
    return {};
  }

 private:
  static constexpr std::int32_t goal = -1;
  struct Reached {
    double length;
    std::int32_t previous;
    bool done;
  };

  Vector middle(std::int32_t side) const {
    const auto at = corners(mesh_, side / 3);
    return (at[side % 3] + at[(side + 1) % 3]) / 2;
  }

  void reach(std::int32_t side, std::int32_t previous, double length, double ahead) {
    const auto [entry, is_new] = reached_.try_emplace(side, Reached{length, previous, false});
    if (!is_new) {
      if (entry->second.done || length >= entry->second.length) return;
      entry->second = {length, previous, false};
    }
    open_.emplace(length + ahead, side);
  }

  void reach_sides(std::int32_t t, int entry, std::int32_t previous, const Vector& from, double length) {
    for (int k = 0; k < 3; ++k) {
      if (k == entry || mesh_.neighbour(t, k).triangle < 0) continue;
      const Vector place = middle(3 * t + k);
      reach(3 * t + k, previous, length + (place - from).norm(), haste * (b_.point - place).norm());
    }
  }

  std::vector<std::int32_t> sides_to(std::int32_t side) const {
    std::vector<std::int32_t> sides;
    for (; side >= 0; side = reached_.at(side).previous) sides.push_back(side);
    std::reverse(sides.begin(), sides.end());
    return sides;
  }

  using Open = std::pair<double, std::int32_t>;  // estimated length of the whole path, side
  const SurfaceMesh& mesh_;
  const Place &a_, &b_;
  std::unordered_map<std::int32_t, Reached> reached_;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
};

/// A side that the strip passes through, unfolded: its ends at the left and the right of who walks along the strip.
struct Gate {
  std::int32_t left, right;  // vertices
  Flat left_at, right_at;
};

/// Where a point lies that is this far to the front (or the back) of a gate when unfolded about it.
Flat unfold(const SurfaceMesh& mesh, const Gate& gate, const Vector& point, double sense) {
  const Vector left = vector(mesh.vertices()[gate.left]);
  const Vector side = (vector(mesh.vertices()[gate.right]) - left).normalized();
  const Vector offset = point - left;
  const double along = side.dot(offset), away = (offset - along * side).norm();
  const Flat flat_side = (gate.right_at - gate.left_at).normalized();
  return gate.left_at + along * flat_side + sense * away * Flat(-flat_side.y(), flat_side.x());
}

std::vector<Gate> unfold_strip(const SurfaceMesh& mesh, const std::vector<std::int32_t>& sides) {
  std::vector<Gate> gates;
  for (const auto side : sides) {
    const auto& vertices = mesh.triangles()[side / 3];
    const std::int32_t first = vertices[side % 3], second = vertices[(side + 1) % 3];
    if (gates.empty()) {
      const double length = mesh.edge_lengths()[mesh.triangle_edges()[side / 3][side % 3]];
      gates.push_back({second, first, Flat(0, 0), Flat(length, 0)});
      continue;
    }
    Gate gate = gates.back();
    const bool keeps_left = first == gate.left || second == gate.left;
    const std::int32_t kept = keeps_left ? gate.left : gate.right, tip = first == kept ? second : first;
    const Flat tip_at = unfold(mesh, gate, vector(mesh.vertices()[tip]), 1);
    (keeps_left ? gate.right : gate.left) = tip;
    (keeps_left ? gate.right_at : gate.left_at) = tip_at;
    gates.push_back(gate);
  }
  return gates;
}

/// A corner of the path, at an end of a gate or at an end of the path (there `gate` is that of all gates or beyond).
struct Bend {
  std::size_t gate;
  Flat at;
};

/// The shortest path through gates: the funnel between the leftmost and the rightmost way from the last bend that still
/// pass all gates narrows, and bends where one would cross the other. The last gate is the goal, left and right alike.
class Funnel {
 public:
  Funnel(const std::vector<Gate>& gates, const Flat& start) : gates_(gates), apex_{0, start} {}

  std::vector<Bend> bends() {
    left_ = right_ = apex_;
    bends_ = {apex_};
    for (std::size_t i = 0; i < gates_.size(); ++i) {
      if (narrow(right_, left_, {i, gates_[i].right_at}, 1) || narrow(left_, right_, {i, gates_[i].left_at}, -1)) {
        i = apex_.gate;  // and on with the gate behind it
      }
    }
    return bends_;
  }

 private:
  /// Moves one wall of the funnel to `next` if that is further in; true if it would cross the other wall instead, which
  /// then becomes a bend. `sense` is 1 for the right wall.
  bool narrow(Bend& wall, const Bend& other, const Bend& next, double sense) {
    const Flat to_next = next.at - apex_.at;
    const bool open = wall.at == apex_.at;
    if (!open && sense * cross(wall.at - apex_.at, to_next) < 0) return false;
    if (open || other.at == apex_.at || sense * cross(other.at - apex_.at, to_next) < 0) {
      wall = next;
      return false;
    }
    apex_ = other;
    left_ = right_ = apex_;
    bends_.push_back(apex_);
    return true;
  }

  const std::vector<Gate>& gates_;
  Bend apex_;
  Bend left_{}, right_{};
  std::vector<Bend> bends_;
};

/// Where the straight line from `from` to `to` passes a gate: the share of the way from its left to its right.
double passing(const Gate& gate, const Flat& from, const Flat& to) {
  const Flat way = to - from;
  const double share = cross(from - gate.left_at, way) / cross(gate.right_at - gate.left_at, way);
  // Along the gate itself either end will do.
  return std::isfinite(share) ? std::clamp(share, least_edge_share, 1 - least_edge_share) : least_edge_share;
}

/// The shortest path that leaves triangles through these sides.
std::vector<CurvePiece> path_through(const SurfaceMesh& mesh, const std::vector<std::int32_t>& sides, const Place& a,
                                     const Place& b) {
  auto gates = unfold_strip(mesh, sides);
  const Flat start = unfold(mesh, gates.front(), a.point, -1), goal = unfold(mesh, gates.back(), b.point, 1);
  gates.push_back({-1, -1, goal, goal});
  auto bends = Funnel(gates, start).bends();
  bends.push_back({gates.size(), goal});

  std::vector<CurvePiece> pieces;
  Vector last = a.point;
  const auto add = [&](std::int32_t t, const Vector& end) {
    pieces.push_back({t, end, end - last});
    last = end;
  };
  std::size_t next = 1;  // bend ahead
  for (std::size_t i = 0; i < sides.size(); ++i) {
    while (next + 1 < bends.size() && bends[next].gate < i) ++next;
    const double share = passing(gates[i], bends[next - 1].at, bends[next].at);
    const Vector left = vector(mesh.vertices()[gates[i].left]), right = vector(mesh.vertices()[gates[i].right]);
    add(sides[i] / 3, (1 - share) * left + share * right);
  }
  add(b.triangle, b.point);
  return pieces;
}

}  // namespace

std::vector<CurvePiece> shortest_path(const SurfaceMesh& mesh, const Place& a, const Place& b) {
  return path_through(mesh, StripSearch(mesh, a, b).run(std::numeric_limits<double>::infinity()), a, b);
}

std::optional<std::vector<CurvePiece>> path_within(const SurfaceMesh& mesh, const Place& a, const Place& b,
                                                   double limit) {
  const auto sides = StripSearch(mesh, a, b).run(limit);
  if (sides.empty()) return std::nullopt;
  return path_through(mesh, sides, a, b);
}

}  // namespace pectinate::detail
