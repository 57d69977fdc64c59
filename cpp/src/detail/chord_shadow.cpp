// SPDX-License-Identifier: MIT
#include "detail/chord_shadow.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pectinate::detail {
namespace {

/// The part of a segment whose height over a plane, start + t rise, is within the radius.
std::optional<Interval> part_within(double start, double rise, double radius) {
  if (rise == 0) return std::abs(start) <= radius ? std::optional(Interval{0, 1}) : std::nullopt;
  const double one = (-radius - start) / rise, other = (radius - start) / rise;
  const Interval part{std::max(0.0, std::min(one, other)), std::min(1.0, std::max(one, other))};
  return part.low <= part.high ? std::optional(part) : std::nullopt;
}

}  // namespace

bool ChordFrame::contains(double x, double chord) const {
  if (!(chord >= 0 && chord <= 1)) return false;
  const double from_long = x - chord * high_x_;
  const double from_short = chord < split_ ? x * split_ - chord * middle_x_
                                           : (x - middle_x_) * (1 - split_) - (chord - split_) * (high_x_ - middle_x_);
  return from_long * from_short <= 0;
}

std::optional<double> ChordFrame::extreme(const Capsule& capsule, double sign) const {
  const Vector& start = capsule.start;
  const Vector axis = capsule.end - start;
  const double h = start.z(), dh = axis.z(), dw = axis.y();
  const auto part = part_within(h, dh, capsule.radius);
  if (!part) return std::nullopt;
  // Balls around the segment cut discs out of the plane. Of these, w + t dw +- sqrt(radius^2 - (h + t dh)^2) is extreme
  // at the height at which both terms change alike.
  double t = sign * dw > 0 ? part->high : part->low;
  if (dh != 0) {
    const double extreme_height = std::copysign(capsule.radius, dh) * dw / std::sqrt(dw * dw + dh * dh);
    t = std::clamp((sign * extreme_height - h) / dh, part->low, part->high);
  }
  const double height = h + t * dh;
  const double disc_radius = std::sqrt(std::max(0.0, capsule.radius * capsule.radius - height * height));
  const double chord = (start.y() + t * dw + sign * disc_radius) / width_;
  return contains(start.x() + t * axis.x(), chord) ? std::optional(chord) : std::nullopt;
}

std::optional<Interval> ChordFrame::part_inside(const Corner& from, const Corner& to, const Capsule& capsule) {
  if (from.inside && to.inside) return Interval{0, 1};
  const Vector e = to.across - from.across;
  const double a = e.squaredNorm(), b = e.dot(from.across);
  const double radius_square = capsule.radius * capsule.radius;
  // Even the axis' line is too far away.
  if ((b >= 0 && from.square > radius_square) || (b <= -a && to.square > radius_square)) return std::nullopt;
  const double discriminant = b * b - a * (from.square - radius_square);
  if (!(discriminant >= 0)) return std::nullopt;
  const double root = std::sqrt(discriminant), rise = to.along - from.along;
  const Vector axis = capsule.end - capsule.start;
  const double axis_square = axis.squaredNorm();
  // The side enters or leaves the cylinder; beyond an end of the axis, it is the ball there that counts.
  const auto crossing = [&](double sign, const Corner& outside) -> std::optional<double> {
    const double t = (-b + sign * root) / a, along = from.along + t * rise;
    if (along >= 0 && along <= 1) return t;
    const double start = from.along - ((a > 0 ? along : outside.along) > 1 ? 1 : 0);
    const double ball_a = a + rise * rise * axis_square, ball_b = b + start * rise * axis_square;
    const double ball_c = from.square + start * start * axis_square - radius_square;
    const double ball = ball_b * ball_b - ball_a * ball_c;
    if (!(ball >= 0)) return std::nullopt;
    return (-ball_b + sign * std::sqrt(ball)) / ball_a;
  };
  Interval part{0, 1};
  if (!from.inside) {
    const auto entry = crossing(-1, from);
    if (!entry || *entry > 1) return std::nullopt;
    part.low = std::max(*entry, 0.0);
  }
  if (!to.inside) {
    const auto exit = crossing(1, to);
    if (!exit || *exit < part.low) return std::nullopt;
    part.high = std::min(*exit, 1.0);
  }
  return part;
}

std::optional<Interval> ChordFrame::shadow(const Capsule& capsule, const View& view) const {
  const auto& [low, middle, high] = view;
  if (low.inside && high.inside) return Interval{0, 1};
  std::optional<Interval> hull;
  const auto include = [&](double from, double to) {
    hull = hull ? Interval{std::min(hull->low, from), std::max(hull->high, to)} : Interval{from, to};
  };
  const auto lowest = low.inside ? std::optional(0.0) : extreme(capsule, -1);
  const auto highest = high.inside ? std::optional(1.0) : extreme(capsule, 1);
  if (lowest) include(*lowest, *lowest);
  if (highest) include(*highest, *highest);
  if (lowest && highest) return hull;
  // What is extreme outside the triangle is cut off at its sides.
  if (const auto part = part_inside(low, high, capsule)) include(part->low, part->high);
  if (const auto part = part_inside(low, middle, capsule)) include(part->low * split_, part->high * split_);
  if (const auto part = part_inside(middle, high, capsule)) {
    include(split_ + part->low * (1 - split_), split_ + part->high * (1 - split_));
  }
  return hull;
}

std::array<std::optional<Interval>, 2> ChordFrame::core(const Capsule& capsule, const View& view) const {
  const auto& [low, middle, high] = view;
  // A chord lies in a convex set if both its ends do: one on low-high, the other on one of the other sides.
  const auto one_end = part_inside(low, high, capsule);
  if (!one_end) return {};
  const auto both_ends = [&](const std::optional<Interval>& other_end, double from, double to) {
    if (!other_end) return std::optional<Interval>{};
    const Interval chords{std::max(one_end->low, from + other_end->low * (to - from)),
                          std::min(one_end->high, from + other_end->high * (to - from))};
    return chords.low <= chords.high ? std::optional(chords) : std::nullopt;
  };
  return {both_ends(part_inside(low, middle, capsule), 0, split_),
          both_ends(part_inside(middle, high, capsule), split_, 1)};
}

}  // namespace pectinate::detail
