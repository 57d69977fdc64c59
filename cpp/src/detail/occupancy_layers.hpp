// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "detail/chord_occupancy.hpp"

namespace pectinate::detail {

/// An exact occupancy of which it is known what each line takes, so that lines can be taken back: what is marked is
/// then bit for bit what the others mark alone.
class OccupancyLayers {
 public:
  /// `occupancy` holds what no line takes, and maybe what the lines take that are added next; it outlives this.
  OccupancyLayers(const SurfaceMesh& mesh, const StreamlineTracer& tracer, ChordOccupancy& occupancy);

  /// Finds out what a line takes, and marks it; the line has a number that is not in use.
  void add(std::int32_t line, const Polyline& polyline);
  /// The triangles of which that line takes chords, each once.
  const std::vector<std::int32_t>& triangles(std::int32_t line) const { return footprints_[line].triangles; }

  /// Takes lines back; what they take is kept until their numbers are used again. Returns their triangles, each once.
  std::vector<std::int32_t> take_back(std::span<const std::int32_t> lines);
  /// Puts lines back that were taken back.
  void put_back(std::span<const std::int32_t> lines);

  /// The lines that take a chord.
  std::vector<std::int32_t> takers(std::int32_t triangle, double chord) const;
  /// Does a line other than this one take a chord?
  bool is_taken_by_other(std::int32_t line, std::int32_t triangle, double chord) const;

 private:
  /// Chords of a triangle that a line takes: for all, or as seeds only.
  struct Share {
    std::int32_t line;
    bool of_seeds;
    Interval chords;

    bool stops(double chord) const { return !of_seeds && chords.low <= chord && chord <= chords.high; }
  };
  /// Where a line takes chords, and, while it is taken back, which: of one triangle after the other.
  struct Footprint {
    std::vector<std::int32_t> triangles, ends;
    std::vector<Share> shares;
  };

  void take_over(std::int32_t triangle, std::int32_t line);
  void mark(std::int32_t triangle, const Share& share);

  ChordOccupancy& occupancy_;
  ChordOccupancy blank_;  // where single lines are marked
  std::vector<Footprint> footprints_;
  std::vector<std::vector<Share>> shares_;  // per triangle: of the lines that are not taken back
  std::vector<Interval> intervals_;         // of the triangle at hand
  std::vector<std::uint64_t> freed_;        // per triangle: when chords of it were taken back last
  std::uint64_t round_ = 0;
};

}  // namespace pectinate::detail
