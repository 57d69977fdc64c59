// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "detail/vec.hpp"

namespace pectinate::detail {

/// So many capsules are looked at together.
inline constexpr int capsule_lanes = 4;

/// Capsules (paper section 2.5), all of which have a value.
struct Capsules {
  std::array<const Vector*, capsule_lanes> start, end;
  std::array<double, capsule_lanes> radius;
};

/// Chords by capsule; none where not low <= high.
struct alignas(32) ChordIntervals {
  std::array<double, capsule_lanes> low, high;
};

/// A triangle laid flat: x along its chords, w across them, from the low corner at the origin to the high one.
struct ChordFrame {
  ChordFrame(const Vector& low, const Vector& middle, const Vector& high, double split);

  Vector low, along, across, normal;  ///< unit vectors, and a corner
  double split, width, high_x, middle_x;
};

/// The chords that enter a capsule: one interval, because capsule and triangle are convex. In closed form.
ChordIntervals chord_shadows(const ChordFrame& frame, const Capsules& capsules);

/// The chords that lie in a capsule with all their length, below and above the middle corner: where that is inside,
/// the two are one interval; where it sticks out, there may be a gap between them.
std::array<ChordIntervals, 2> chord_cores(const ChordFrame& frame, const Capsules& capsules);

inline ChordFrame::ChordFrame(const Vector& low_corner, const Vector& middle, const Vector& high, double split_at)
    : low(low_corner), split(split_at) {
  const Vector low_to_high = high - low;
  along = (low + split * low_to_high - middle).normalized();
  high_x = along.dot(low_to_high);
  middle_x = along.dot(middle - low);
  across = low_to_high - high_x * along;
  width = across.norm();
  across /= width;
  normal = along.cross(across);
}

}  // namespace pectinate::detail
