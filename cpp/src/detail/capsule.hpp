// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "detail/vec.hpp"

namespace pectinate::detail {

/// Keeps rounding on the safe side of distances that are kept; in these distances.
inline constexpr double guard = 2e-6;

/// A closed interval of a line's parameter.
struct Interval {
  double low, high;
};

/// All points within `radius` of the segment from `start` to `end` (paper section 2.5: two spheres and a cylinder).
struct Capsule {
  Vector start, end;
  double radius;
};

inline double distance_to_segment(const Vector& point, const Vector& start, const Vector& end) {
  const Vector axis = end - start, offset = point - start;
  const double square = axis.squaredNorm();
  const double along = square > 0 ? std::clamp(offset.dot(axis) / square, 0.0, 1.0) : 0;
  return (offset - along * axis).norm();
}

/// Where a t^2 + 2 b t + c <= 0, for a >= 0.
inline std::optional<Interval> non_positive(double a, double b, double c) {
  if (a == 0) return c <= 0 ? std::optional(Interval{-1e300, 1e300}) : std::nullopt;  // then b is 0 as well
  const double discriminant = b * b - a * c;
  if (!(discriminant >= 0)) return std::nullopt;
  const double root = std::sqrt(discriminant);
  return Interval{(-b - root) / a, (-b + root) / a};
}

/// The part of the segment p + t e, t in [0, 1], inside a capsule, in closed form. A capsule is convex: it is one
/// interval.
inline std::optional<Interval> intersect(const Capsule& capsule, const Vector& p, const Vector& e) {
  const double square = capsule.radius * capsule.radius;
  const Vector axis = capsule.end - capsule.start, from_start = p - capsule.start;
  const auto in_ball = [&](bool at_end) {
    const Vector from_centre = at_end ? Vector(p - capsule.end) : from_start;
    return non_positive(e.squaredNorm(), e.dot(from_centre), from_centre.squaredNorm() - square);
  };
  const double axis_square = axis.squaredNorm();
  std::optional<Interval> part;
  if (axis_square > 0) {
    const double p_along = from_start.dot(axis) / axis_square, e_along = e.dot(axis) / axis_square;
    const Vector p_across = from_start - p_along * axis, e_across = e - e_along * axis;
    part = non_positive(e_across.squaredNorm(), e_across.dot(p_across), p_across.squaredNorm() - square);
    if (!part) return std::nullopt;
    // Where the cylinder is entered or left beyond an end of the axis, it is the ball there that counts.
    for (double Interval::* end : {&Interval::low, &Interval::high}) {
      const double along = p_along + *part.*end * e_along;
      if (along >= 0 && along <= 1) continue;
      const auto ball = in_ball(along > 1);
      if (!ball) return std::nullopt;
      *part.*end = *ball.*end;
    }
  } else {
    part = in_ball(false);
  }
  if (!part || part->high < 0 || part->low > 1) return std::nullopt;
  return Interval{std::max(part->low, 0.0), std::min(part->high, 1.0)};
}

}  // namespace pectinate::detail
