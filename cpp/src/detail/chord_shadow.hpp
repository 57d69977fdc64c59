// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <optional>

#include "detail/capsule.hpp"
#include "detail/vec.hpp"

namespace pectinate::detail {

/// A triangle laid flat: x along its chords, w across them, from the low corner at the origin to the high one.
class ChordFrame {
 public:
  ChordFrame(const Vector& low, const Vector& middle, const Vector& high, double split);

  /// A point in the triangle's coordinates: x, w and height.
  Vector flat(const Vector& point) const {
    const Vector from_low = point - low_;
    return {from_low.dot(along_), from_low.dot(across_), from_low.dot(normal_)};
  }

  // Capsules are given in these coordinates.

  /// A bound for the chords that enter a capsule; none if it misses the triangle's plane.
  std::optional<Interval> reach(const Capsule& capsule) const;

  /// Where the triangle lies along a capsule.
  struct Range {
    bool is_before_start, is_beyond_end;  ///< then nothing but the ball at that end can meet the triangle
  };
  Range range_along(const Capsule& capsule) const {
    const Vector axis = capsule.end - capsule.start;
    const double low = -capsule.start.dot(axis);
    const double middle = low + middle_x_ * axis.x() + split_ * width_ * axis.y();
    const double high = low + high_x_ * axis.x() + width_ * axis.y();
    return {std::max({low, middle, high}) <= 0, std::min({low, middle, high}) >= axis.squaredNorm()};
  }

  /// A corner of the triangle as a capsule sees it.
  struct Corner {
    double along;   ///< the axis, in [0, 1] beside it
    Vector across;  ///< from the axis' line
    double square;  ///< of `across`
    bool inside;    ///< the capsule
  };
  struct View {
    Corner low, middle, high;
  };
  View look(const Capsule& capsule) const;

  /// The chords that enter a capsule: one interval, because capsule and triangle are convex. In closed form; none if
  /// the capsule misses the triangle.
  std::optional<Interval> shadow(const Capsule& capsule, const View& view) const;

  double width() const { return width_; }

 private:
  /// The part of the side between two corners that is inside the capsule.
  static std::optional<Interval> part_inside(const Corner& from, const Corner& to, const Capsule& capsule);
  /// The chord at which the capsule's cut with the plane is lowest (sign -1) or highest (1), if inside the triangle.
  std::optional<double> extreme(const Capsule& capsule, double sign) const;
  bool contains(double x, double chord) const;

  Vector low_, along_, across_, normal_;
  double split_, width_, high_x_, middle_x_;
};

}  // namespace pectinate::detail
