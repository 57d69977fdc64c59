// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "pectinate/types.hpp"

namespace pectinate::detail {

/// So many triangles are measured together.
inline constexpr int measured_lanes = 4;

/// Triangles with orientations in their planes.
struct Faces {
  using Places = std::array<const Vec3*, measured_lanes>;

  std::array<Places, 3> corners;
  Places directions;
};

/// How orientations stand to their triangles, whose sides begin at the corners of the same number; by triangle.
struct alignas(32) ChordMeasures {
  using Numbers = std::array<double, measured_lanes>;

  std::array<Numbers, 3> cosine;  ///< of the angle, in (0, pi), from a side to the orientation as it runs inwards there
  Numbers middle;                 ///< the corner between the others across the orientation: 0, 1 or 2
  Numbers split;                  ///< where its chord crosses the opposite side, from the corner after it; in (0, 1)
  Numbers longest_chord, width;
  unsigned along_sides;  ///< by bit: within `least_angle_to_side` of a side
};

/// An orientation this close to a side, in radians, is turned away from it: the infinitesimal change of section 2.4.
inline constexpr double least_angle_to_side = 1e-9;

ChordMeasures measure_chords(const Faces& faces);

}  // namespace pectinate::detail
