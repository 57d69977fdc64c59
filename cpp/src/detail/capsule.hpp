// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "detail/vec.hpp"

namespace pectinate::detail {

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
  std::optional<Interval> hull;
  const auto include = [&](const std::optional<Interval>& part) {
    if (!part || part->low > part->high) return;
    hull = hull ? Interval{std::min(hull->low, part->low), std::max(hull->high, part->high)} : *part;
  };
  const Vector axis = capsule.end - capsule.start;
  const Vector from_start = p - capsule.start, from_end = p - capsule.end;
  include(non_positive(e.squaredNorm(), e.dot(from_start), from_start.squaredNorm() - square));
  include(non_positive(e.squaredNorm(), e.dot(from_end), from_end.squaredNorm() - square));
  const double axis_square = axis.squaredNorm();
  if (axis_square > 0) {
    const double p_along = from_start.dot(axis) / axis_square, e_along = e.dot(axis) / axis_square;
    const Vector p_across = from_start - p_along * axis, e_across = e - e_along * axis;
    auto cylinder = non_positive(e_across.squaredNorm(), e_across.dot(p_across), p_across.squaredNorm() - square);
    if (cylinder && e_along != 0) {
      const double first = -p_along / e_along, last = (1 - p_along) / e_along;
      cylinder->low = std::max(cylinder->low, std::min(first, last));
      cylinder->high = std::min(cylinder->high, std::max(first, last));
    } else if (p_along < 0 || p_along > 1) {
      cylinder.reset();
    }
    include(cylinder);
  }
  if (!hull || hull->high < 0 || hull->low > 1) return std::nullopt;
  return Interval{std::max(hull->low, 0.0), std::min(hull->high, 1.0)};
}

}  // namespace pectinate::detail
