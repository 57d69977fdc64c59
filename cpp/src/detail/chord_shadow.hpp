// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "detail/vec.hpp"

namespace pectinate::detail {

/// So many questions are answered together.
inline constexpr int shadow_lanes = 4;

/// Which chords of a triangle does a capsule (paper section 2.5) take? One question a lane; all have a value.
struct ShadowQuestions {
  using Places = std::array<const Vector*, shadow_lanes>;
  using Numbers = std::array<double, shadow_lanes>;

  Places low, middle, high;  ///< corners
  Numbers split;             ///< where the chord through the middle corner crosses the side low-high
  Places start, end;         ///< of the capsule's axis
  Numbers radius;
};

/// Chords by lane; none where not low <= high.
struct alignas(32) ChordIntervals {
  ShadowQuestions::Numbers low, high;
};

struct alignas(32) Shadows {
  ChordIntervals chords;
  ShadowQuestions::Numbers width;  ///< of the triangles, across their chords
};

/// The chords that enter the capsules: one interval each, because capsule and triangle are convex. In closed form.
Shadows chord_shadows(const ShadowQuestions& questions);

/// The chords that lie in the capsules with all their length, below and above the middle corner: where that is inside,
/// the two are one interval; where it sticks out, there may be a gap between them.
std::array<ChordIntervals, 2> chord_cores(const ShadowQuestions& questions);

}  // namespace pectinate::detail
