// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "detail/covered_centres.hpp"
#include "detail/held_lines.hpp"
#include "detail/longest_first.hpp"
#include "detail/occupancy_layers.hpp"
#include "detail/random.hpp"

namespace pectinate::detail {

/// Places lines as `LineFiller` does, then makes them longer on average by destroying and repairing: a round takes out
/// some lines that lie together, and fills the place with others.
///
/// After every round nothing is free, all lines keep their distance, and each end is where it is for the reason that it
/// has. A round that makes things worse is mostly undone, but not always, or the search would soon be stuck; in the end
/// it goes back to the best that it has seen, by mean length. Total length and coverage are never less than at first.
class Polisher {
 public:
  Polisher(const SurfaceMesh& mesh, const StreamlineTracer& tracer, const LineRules& rules, ChordOccupancy& occupancy,
           std::uint64_t random_seed);

  /// Places lines; false if it was stopped, then there is no polishing.
  bool fill(const std::function<bool()>& go_on);
  /// Plays rounds while `go_on`, which is given how many were played; returns how many that are.
  std::int64_t polish(const std::function<bool(std::int64_t)>& go_on);
  /// Calls `place` for all lines that lie there now, in the order in which they were placed.
  void for_each(const std::function<void(const PlacedLine&)>& place) const;

 private:
  using Numbers = std::vector<std::int32_t>;

  /// Lines taken out, and lines that lie there now.
  struct Change {
    Numbers gone, come;
  };
  /// What a change does to the sums over all lines.
  struct Effect {
    double count = 0, length = 0, squares = 0, free = 0, uncovered = 0;
  };

  void play_round();
  Numbers choose();
  Numbers choose_to_grow();
  Numbers choose_short();
  void choose_resting(Numbers& chosen);
  std::int32_t draw_line() { return lines_.present()[random_.below(lines_.present().size())]; }
  std::int32_t draw_short_line();
  std::int32_t draw_by_length();
  bool rests_on(std::int32_t line, std::int32_t triangle, const Numbers& supports) const;

  FreedRegion take_out(const Numbers& lines, std::vector<ChordPlace> first, bool at_random);
  void replace(const Numbers& lines, std::vector<ChordPlace> first, bool at_random);
  bool let_long_line_give_way();
  std::vector<Chord> without_end(std::int32_t line, double length);
  bool mend_loose_ends();
  Numbers loose_lines() const;

  Change finished_change();
  void note_free(std::int32_t line);
  double free_area(std::int32_t triangle) const;
  Effect effect_of(const Change& change) const;
  bool accepts(const Effect& effect);
  void undo(const Change& change);
  void keep(Change change, const Effect& effect);
  void settle();
  void go_back();
  double mean_length() const { return total_length_ / static_cast<double>(lines_.present().size()); }

  const SurfaceMesh& mesh_;
  const Sheet& sheet_;
  HeldLines lines_;
  LineFiller filler_;
  ChordOccupancy& occupancy_;
  OccupancyLayers layers_;
  CoveredCentres centres_;
  Random random_;
  std::int32_t current_ = -1;  // the line that is being placed
  double total_length_ = 0, least_length_ = 0;
  double free_ = 0, tolerance_ = 0;  // area of chords that are not taken, more than at first
  double uncovered_at_first_ = 0;
  double rounds_at_half_ = 0;  // until the temperature is half of what it was

  // Of the round that is being played:
  std::vector<ChordPlace> first_;      // where the candidates start that come before all others
  Numbers taken_out_, placed_;         // some are both
  Numbers freed_;                      // triangles, each once
  double free_before_ = 0;             // area of chords of those
  double uncovered_before_ = 0;        // of the whole surface
  std::vector<std::uint64_t> rounds_;  // per triangle: in which it was freed last
  std::uint64_t round_ = 0;

  // Since the best:
  double best_mean_ = 0, best_length_ = 0, best_free_ = 0;
  std::vector<Change> changes_;
  std::size_t replaced_count_ = 0;
};

}  // namespace pectinate::detail
