// SPDX-License-Identifier: MIT
#include "detail/bent_cone.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace pectinate::detail {

BentCone::BentCone(const Ends& ends, const Vector& direction) : ends_(ends), forward_(direction.normalized()) {
  const Vector chord = ends.end - ends.start;
  inward_ = (chord - forward_.dot(chord) * forward_).normalized();
  across_ = forward_.cross(inward_);
  arc_radius_ = chord.squaredNorm() / (2 * inward_.dot(chord));
  arc_angle_ = std::atan2(forward_.dot(chord), arc_radius_ - inward_.dot(chord));
  if (arc_angle_ < 0) arc_angle_ += 2 * std::numbers::pi;
}

Sample BentCone::sample(const Vector& point) const {
  const Vector from_centre = point - ends_.start - arc_radius_ * inward_;
  const double along = forward_.dot(from_centre), out = -inward_.dot(from_centre), beside = across_.dot(from_centre);
  const double share = std::atan2(along, out) / arc_angle_;
  if (share < 0 || share > 1) return sample_end(point);

  const double from_axis = std::max(std::hypot(along, out), 1e-9);
  const Vector radial = (along * forward_ - out * inward_) / from_axis;
  const Vector tangent = (out * forward_ + along * inward_) / from_axis;
  const double from_arc = std::hypot(from_axis - arc_radius_, beside);
  // The radius changes smoothly from a rest to a rest, so that the end caps fit.
  const double growth = ends_.end_radius - ends_.start_radius;
  const double radius = ends_.start_radius + growth * share * share * (3 - 2 * share);
  const double slope = growth * 6 * share * (1 - share) / (arc_angle_ * from_axis);
  const Vector away = ((from_axis - arc_radius_) * radial + beside * across_) / std::max(from_arc, 1e-9);
  return {from_arc - radius, away - slope * tangent};
}

Sample BentCone::sample_end(const Vector& point) const {
  const Sample at_start = detail::sample(Ball{ends_.start, ends_.start_radius}, point);
  const Sample at_end = detail::sample(Ball{ends_.end, ends_.end_radius}, point);
  return at_start.value < at_end.value ? at_start : at_end;
}

Box BentCone::bounds() const {
  const double bulge = arc_radius_ * (1 - std::cos(std::min(arc_angle_, std::numbers::pi) / 2));
  return widen(detail::bounds(RoundCone{ends_.start, ends_.end, ends_.start_radius, ends_.end_radius}), bulge);
}

}  // namespace pectinate::detail
