// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>

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

/// Where a chord lies.
struct ChordPlace {
  std::int32_t triangle;
  double coordinate;
};

using Chords = LargeArray<Chord>;

/// At the first and the last point of a line, the chord that follows, if it is asked for.
using ChordsAhead = std::array<std::optional<Chord>, 2>;

/// A stretch [first, last) of the stored chords.
struct Stretch {
  std::int64_t first, last;

  bool operator==(const Stretch&) const = default;
};

/// In place of why a trajectory ends: it would go on, but was left off.
inline constexpr auto left_off = static_cast<StopReason>(stop_reason_count);

/// A curve of the field, from stop to stop, or to where it was left off. There may be more than triangles: it is small.
struct Trajectory {
  std::int64_t first;
  std::int32_t length;  // in chords
  std::array<StopReason, 2> ends;
  bool hugs;  ///< a placed line

  Trajectory(const Stretch& stretch, const std::array<StopReason, 2>& end_reasons, bool does_hug)
      : first(stretch.first),
        length(static_cast<std::int32_t>(stretch.last - stretch.first)),
        ends(end_reasons),
        hugs(does_hug) {}

  Stretch stretch() const { return {first, first + length}; }
  bool is_closed() const { return ends[0] == StopReason::closed; }
  /// Is an end of a stretch of it one where it was left off?
  bool is_left_off_at(const Stretch& part) const {
    return (part.first == first && ends[0] == left_off) || (part.last == first + length && ends[1] == left_off);
  }
};

/// A stretch of a trajectory under the length that it had when it was last looked at; it only ever gets shorter.
struct Piece {
  double key;
  std::int64_t first;
  std::int32_t length;  // in chords
  std::uint32_t code;   // 2 * trajectory, + 1 if it is known to keep criterion 5

  Piece(double heap_key, const Stretch& stretch, std::int32_t trajectory, bool is_self_free)
      : key(heap_key),
        first(stretch.first),
        length(static_cast<std::int32_t>(stretch.last - stretch.first)),
        code(2 * static_cast<std::uint32_t>(trajectory) + is_self_free) {}

  Stretch stretch() const { return {first, first + length}; }
  std::int32_t trajectory() const { return static_cast<std::int32_t>(code >> 1); }
  bool is_self_free() const { return code & 1; }
  void set_trajectory(std::int32_t trajectory) { code = 2 * static_cast<std::uint32_t>(trajectory) + is_self_free(); }

  bool operator<(const Piece& other) const { return key != other.key ? key < other.key : first > other.first; }
};

}  // namespace pectinate::detail
