// SPDX-License-Identifier: MIT
#pragma once

#include "detail/candidates.hpp"
#include "detail/chord_occupancy.hpp"
#include "detail/chord_tracer.hpp"

namespace pectinate::detail {

/// Traces trajectories and stores them as candidates.
class CandidateTracer {
 public:
  CandidateTracer(const StreamlineTracer& tracer, const ChordOccupancy& occupancy, const LineRules& rules,
                  Candidates& candidates);

  /// d_sep in a triangle of the sheet, and everywhere; that is 0 where it varies.
  double separation(std::int32_t triangle) const { return chord_tracer_.separation(triangle); }
  double separation() const { return chord_tracer_.separation(); }

  /// Stores the trajectory through a chord; and the closed curves that it winds onto, if the rules ask for them: then
  /// none is left off.
  Trajectory add(const ChordPlace& start, const ChordTracer::Obstacles& obstacles, bool hugs);

 private:
  void add_closed(const Trajectory& trajectory);
  void add_closed(const Chords& orbit, bool hugs);

  const Sheet& sheet_;
  const ChordOccupancy& occupancy_;
  bool close_loops_;
  ChordTracer chord_tracer_;
  Candidates& candidates_;
};

}  // namespace pectinate::detail
