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

ChordFrame::ChordFrame(const SurfaceMesh& mesh, std::int32_t triangle, const TriangleCrossings& crossings)
    : normal_(vector(mesh.triangle_normals()[triangle])), split_(crossings.split), width_(crossings.width) {
  const auto& corners = mesh.triangles()[triangle];
  const int middle = crossings.middle;
  middle_ = vector(mesh.vertices()[corners[middle]]);
  low_ = vector(mesh.vertices()[corners[(middle + 1) % 3]]);
  high_ = vector(mesh.vertices()[corners[(middle + 2) % 3]]);
  along_ = (low_ + split_ * (high_ - low_) - middle_).normalized();
  across_ = normal_.cross(along_);
  if (across_.dot(high_ - low_) < 0) across_ = -across_;
  high_x_ = along_.dot(high_ - low_);
  middle_x_ = along_.dot(middle_ - low_);
}

bool ChordFrame::contains(double x, double w) const {
  const double chord = w / width_;
  if (!(chord >= 0 && chord <= 1)) return false;
  const double on_long = chord * high_x_;
  const double on_short =
      chord < split_ ? chord / split_ * middle_x_ : middle_x_ + (chord - split_) / (1 - split_) * (high_x_ - middle_x_);
  return (x - on_long) * (x - on_short) <= 0;
}

std::optional<ChordFrame::Reach> ChordFrame::reach(const Capsule& capsule) const {
  const Vector start = capsule.start - low_, axis = capsule.end - capsule.start;
  const double h = start.dot(normal_), dh = axis.dot(normal_);
  const auto part = part_within(h, dh, capsule.radius);
  if (!part) return std::nullopt;
  const double x = start.dot(along_), dx = axis.dot(along_), w = start.dot(across_), dw = axis.dot(across_);
  // Balls around the segment cut discs out of the plane. Of these, w + t dw +- sqrt(radius^2 - (h + t dh)^2) is extreme
  // at the height at which both terms change alike.
  const double extreme_height = dh != 0 ? std::copysign(capsule.radius, dh) * dw / std::sqrt(dw * dw + dh * dh) : 0;
  const auto extreme = [&](double sign) {
    const double t = dh == 0 ? (sign * dw > 0 ? part->high : part->low)
                             : std::clamp((sign * extreme_height - h) / dh, part->low, part->high);
    const double height = h + t * dh;
    const double disc_radius = std::sqrt(std::max(0.0, capsule.radius * capsule.radius - height * height));
    return std::pair{x + t * dx, w + t * dw + sign * disc_radius};
  };
  const auto [low_x, low_w] = extreme(-1);
  const auto [high_x, high_w] = extreme(1);
  return Reach{{low_w / width_, high_w / width_}, contains(low_x, low_w), contains(high_x, high_w)};
}

std::optional<Interval> ChordFrame::shadow(const Capsule& capsule, const Reach& reach) const {
  if (reach.low_inside && reach.high_inside) return reach.chords;
  std::optional<Interval> hull;
  const auto include = [&](double low, double high) {
    hull = hull ? Interval{std::min(hull->low, low), std::max(hull->high, high)} : Interval{low, high};
  };
  // What is extreme outside the triangle is cut off at its sides.
  if (reach.low_inside) include(reach.chords.low, reach.chords.low);
  if (reach.high_inside) include(reach.chords.high, reach.chords.high);
  if (const auto part = intersect(capsule, low_, high_ - low_)) include(part->low, part->high);
  if (const auto part = intersect(capsule, low_, middle_ - low_)) include(part->low * split_, part->high * split_);
  if (const auto part = intersect(capsule, middle_, high_ - middle_)) {
    include(split_ + part->low * (1 - split_), split_ + part->high * (1 - split_));
  }
  return hull;
}

}  // namespace pectinate::detail
