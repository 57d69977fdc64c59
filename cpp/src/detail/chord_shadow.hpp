// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
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

  /// The chords that lie in a capsule with all their length, below and above the middle corner: where that is inside,
  /// the two are one interval; where it sticks out, there may be a gap between them.
  std::array<std::optional<Interval>, 2> core(const Capsule& capsule, const View& view) const;

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

// Inline, because marking is made of these.

inline ChordFrame::ChordFrame(const Vector& low, const Vector& middle, const Vector& high, double split)
    : low_(low), split_(split) {
  const Vector low_to_high = high - low;
  along_ = (low + split * low_to_high - middle).normalized();
  high_x_ = along_.dot(low_to_high);
  middle_x_ = along_.dot(middle - low);
  across_ = low_to_high - high_x_ * along_;
  width_ = across_.norm();
  across_ /= width_;
  normal_ = along_.cross(across_);
}

inline std::optional<Interval> ChordFrame::reach(const Capsule& capsule) const {
  const auto& [start, end, radius] = capsule;
  const bool meets_plane = (start.z() < 0) != (end.z() < 0);
  const double height = meets_plane ? 0 : std::min(std::abs(start.z()), std::abs(end.z()));
  const double square = radius * radius - height * height;
  if (!(square >= 0)) return std::nullopt;
  const double disc_radius = std::sqrt(square);
  return Interval{(std::min(start.y(), end.y()) - disc_radius) / width_,
                  (std::max(start.y(), end.y()) + disc_radius) / width_};
}

inline ChordFrame::View ChordFrame::look(const Capsule& capsule) const {
  const Vector axis = capsule.end - capsule.start;
  const double axis_square = axis.squaredNorm(), inverse = axis_square > 0 ? 1 / axis_square : 0;
  const auto look_at = [&](double x, double w) -> Corner {
    const Vector from_start = Vector(x, w, 0) - capsule.start;
    const double along = from_start.dot(axis) * inverse;
    const Vector across = from_start - along * axis;
    const double beyond = along - std::clamp(along, 0.0, 1.0), square = across.squaredNorm();
    return {along, across, square, square + beyond * beyond * axis_square <= capsule.radius * capsule.radius};
  };
  return {look_at(0, 0), look_at(middle_x_, split_ * width_), look_at(high_x_, width_)};
}

}  // namespace pectinate::detail
