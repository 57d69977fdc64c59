// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "detail/sheet.hpp"
#include "detail/trajectories.hpp"
#include "pectinate/placement.hpp"
#include "pectinate/tracing.hpp"

namespace pectinate::detail {

/// A placed streamline; who placed it or keeps it owns the chords.
struct PlacedLine {
  std::span<const Chord> chords;
  bool is_closed = false;
  std::array<StopReason, 2> stop_reasons{};
  std::array<bool, 2> is_cut{};  ///< at an end the trajectory goes on, through a chord that was free
};

/// At the first and the last point of a line, the chord that it does not take because another line or a part of its own
/// is near; it runs away from the line. None where a trajectory itself ended because it came back to a triangle.
ChordsAhead chords_ahead(const Sheet& sheet, const PlacedLine& line);

/// Makes room for so many points.
void reserve(std::size_t point_count, Placement& placement);

double length_of(const Sheet& sheet, const PlacedLine& line);

/// Lines in the order in which they were placed, as chords: until all are there and nothing else is needed, these take
/// less than a third of the memory of points with their triangles and weights.
class PlacedLines {
 public:
  /// Memory for so many chords costs nothing as long as it is not written to.
  explicit PlacedLines(std::size_t chord_count) { chords_.reserve(chord_count); }

  void add(const PlacedLine& line);
  std::size_t count() const { return lines_.size(); }
  PlacedLine operator[](std::size_t line) const;

  /// Writes all streamlines as they are known to the world, with room for a point more at each end.
  void write(const Sheet& sheet, Placement& placement) const;

 private:
  struct Line {
    std::int64_t first;
    std::int32_t count;  // of chords
    bool is_closed;
    std::array<StopReason, 2> stop_reasons;
    std::array<bool, 2> is_cut;
  };

  void write(const Sheet& sheet, const PlacedLine& line, Placement& placement) const;

  std::vector<Chord> chords_;
  std::vector<Line> lines_;
};

}  // namespace pectinate::detail
