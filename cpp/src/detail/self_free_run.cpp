// SPDX-License-Identifier: MIT
#include "detail/self_free_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "detail/segment_distance.hpp"

namespace pectinate::detail {
namespace {

struct Ball {
  Vector centre;
  double radius;
};

/// A little more than enough: rounding must not hide what is near.
bool may_be_near(const Ball& a, const Ball& b, double distance) {
  const double reach = (a.radius + b.radius + distance) * (1 + 1e-12);
  return (a.centre - b.centre).squaredNorm() <= reach * reach;
}

/// A polyline in a tree of balls: each holds a stretch of it, and those below hold its parts.
class BallTree {
 public:
  static constexpr std::size_t branching = 8;

  explicit BallTree(const std::vector<Vector>& points) : points_(points) {
    const auto count = points.size() - 1;
    for (std::size_t size = branching; levels_.empty() || levels_.back().size() > 1; size *= branching) {
      auto& level = levels_.emplace_back();
      for (std::size_t first = 0; first < count; first += size) {
        level.push_back(ball_around(first, std::min(first + size, count)));
      }
    }
  }

  /// Calls visit(first, last, ball) for each lowest stretch of segments whose ball comes nearer than `distance` to that
  /// of the one with index `leaf`, and that lies neither behind it nor wholly before segment `first`; the last ones
  /// first.
  template <class Visit>
  void visit_near(std::size_t leaf, double distance, std::size_t first, const Visit& visit) const {
    descend(levels_.size() - 1, 0, {leaf, first, distance}, visit);
  }

 private:
  struct Query {
    std::size_t leaf, first;
    double distance;
  };

  Ball ball_around(std::size_t first, std::size_t last) const {
    const Vector centre = (points_[first] + points_[(first + last) / 2] + points_[last]) / 3;
    double square = 0;
    for (auto i = first; i <= last; ++i) square = std::max(square, (points_[i] - centre).squaredNorm());
    return {centre, std::sqrt(square)};
  }

  template <class Visit>
  void descend(std::size_t level, std::size_t index, const Query& query, const Visit& visit) const {
    const auto &ball = levels_[level][index], &other = levels_[0][query.leaf];
    if (!may_be_near(ball, other, query.distance)) return;
    if (level == 0) {
      visit(index * branching, std::min((index + 1) * branching, points_.size() - 1), ball);
      return;
    }
    const auto first = index * branching, last = std::min(first + branching, levels_[level - 1].size());
    for (auto child = last; child-- > first;) {
      if (is_between(level - 1, child, query)) descend(level - 1, child, query, visit);
    }
  }

  /// Does a ball hold anything from the query's first segment up to its leaf?
  static bool is_between(std::size_t level, std::size_t index, const Query& query) {
    std::size_t leaves = 1;
    for (; level > 0; --level) leaves *= branching;
    return index * leaves <= query.leaf && (index + 1) * leaves * branching > query.first;
  }

  const std::vector<Vector>& points_;
  std::vector<std::vector<Ball>> levels_;
};

/// The segments of a polyline in balls of their own.
std::vector<Ball> balls_around_segments(const std::vector<Vector>& points) {
  std::vector<Ball> balls;
  balls.reserve(points.size() - 1);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    balls.push_back({(points[i] + points[i + 1]) / 2, (points[i + 1] - points[i]).norm() / 2});
  }
  return balls;
}

/// From the first point to each.
std::vector<double> arc_lengths(const std::vector<Vector>& points) {
  std::vector<double> arc{0};
  arc.reserve(points.size());
  for (std::size_t i = 0; i + 1 < points.size(); ++i) arc.push_back(arc.back() + (points[i + 1] - points[i]).norm());
  return arc;
}

}  // namespace

std::vector<std::int32_t> self_free_starts(const std::vector<Vector>& points, double distance, double arc_gap) {
  const auto count = points.size() - 1;
  const auto arc = arc_lengths(points);
  std::vector<std::int32_t> starts(count, 0);
  if (arc.back() <= arc_gap) return starts;

  const auto segments = balls_around_segments(points);
  const auto are_near = [&](std::size_t i, std::size_t j) {
    return may_be_near(segments[i], segments[j], distance) &&
           segment_distance(points[i], points[i + 1], points[j], points[j + 1]) < distance;
  };
  const BallTree tree(points);
  // Two pointers: the run that ends with segment `last` cannot begin before `first`.
  std::size_t first = 0;
  std::array<std::size_t, BallTree::branching> least_first;
  for (std::size_t leaf = 0; leaf * BallTree::branching < count; ++leaf) {
    const auto begin = leaf * BallTree::branching, end = std::min(begin + BallTree::branching, count);
    least_first.fill(first);
    tree.visit_near(leaf, distance, first, [&](std::size_t from, std::size_t to, const auto& ball) {
      if (arc[end - 1] - arc[from + 1] <= arc_gap) return;
      for (auto last = begin; last < end; ++last) {
        if (!may_be_near(ball, segments[last], distance)) continue;
        for (auto i = std::min(to, last); i-- > std::max(from, least_first[last - begin]);) {
          if (arc[last] - arc[i + 1] <= arc_gap) continue;
          if (!are_near(i, last)) continue;
          least_first[last - begin] = i + 1;
          break;
        }
      }
    });
    for (auto last = begin; last < end; ++last) {
      first = std::max(first, least_first[last - begin]);
      starts[last] = static_cast<std::int32_t>(first);
    }
  }
  return starts;
}

bool is_self_free_loop(const std::vector<Vector>& points, double distance, double arc_gap) {
  const auto count = points.size() - 1;
  const auto arc = arc_lengths(points);
  const BallTree tree(points);
  bool is_free = true;
  for (std::size_t leaf = 0; leaf * BallTree::branching < count && is_free; ++leaf) {
    const auto begin = leaf * BallTree::branching, end = std::min(begin + BallTree::branching, count);
    tree.visit_near(leaf, distance, 0, [&](std::size_t from, std::size_t to, const auto&) {
      for (auto j = begin; j < end && is_free; ++j) {
        for (auto i = from; i < std::min(to, j) && is_free; ++i) {
          if (arc[j] - arc[i + 1] <= arc_gap || arc.back() - arc[j + 1] + arc[i] <= arc_gap) continue;
          is_free = segment_distance(points[i], points[i + 1], points[j], points[j + 1]) >= distance;
        }
      }
    });
  }
  return is_free;
}

}  // namespace pectinate::detail
