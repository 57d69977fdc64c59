// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "detail/large_array.hpp"
#include "pectinate/tracing.hpp"

namespace pectinate::detail {

/// One chord of a trajectory; `direction` says through which side it leaves.
struct Chord {
  double coordinate;
  float length;
  std::int32_t code;  ///< 2 * triangle, + 1 if it leaves through low_high

  std::int32_t triangle() const { return code >> 1; }
  bool leaves_through_low_high() const { return code & 1; }
};

using Chords = LargeArray<Chord>;

/// A stretch [first, last) of the stored chords.
struct Stretch {
  std::int64_t first, last;
};

/// A curve of the field, from stop to stop.
struct Trajectory {
  Stretch stretch;
  std::array<StopReason, 2> ends;
  double bonus;

  bool is_closed() const { return ends[0] == StopReason::closed; }
};

/// A stretch of a trajectory under the length that it had when it was last looked at; it only ever gets shorter.
struct Piece {
  double key;
  Stretch stretch;
  std::int32_t trajectory;
  bool is_self_free;  ///< known to keep criterion 5

  bool operator<(const Piece& other) const {
    return key != other.key ? key < other.key : stretch.first > other.stretch.first;
  }
};

}  // namespace pectinate::detail
