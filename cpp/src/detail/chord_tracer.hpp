// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "detail/chord_occupancy.hpp"
#include "detail/self_approach.hpp"
#include "detail/sheet.hpp"
#include "detail/trajectories.hpp"
#include "detail/triangle_marks.hpp"
#include "detail/visited_chords.hpp"
#include "pectinate/tracing.hpp"

namespace pectinate::detail {

/// Which lines there may be.
struct LineRules {
  double minimum_length = 0;
  bool close_loops = false;  ///< closed curves of the field become closed lines
};

/// Traces trajectories from chord to chord. What has come far without an end, as they do on smooth fields, is looked at
/// now and then: where it has come back to itself (criterion 5) it ends. So it needs not wind through all the surface
/// until by chance it comes to a triangle for the second time. But where closed curves are asked for it must: they are
/// what it winds onto. Where d_sep varies, criterion 5 depends on where a line begins, and it winds on, too.
class ChordTracer {
 public:
  ChordTracer(const StreamlineTracer& tracer, const ChordOccupancy& occupancy, const LineRules& rules);

  /// d_sep in a triangle of the sheet.
  double separation(std::int32_t triangle) const {
    return separation_ > 0 ? separation_ : tracer_.separation_distance(sheet_.mesh_triangle(triangle));
  }
  /// 0 where it varies.
  double separation() const { return separation_; }

  /// What else ends a trajectory.
  struct Obstacles {
    bool others = false;                    ///< chords that other streamlines occupy
    const TriangleMarks* served = nullptr;  ///< if given: to have come far through these, where it is left off
  };

  /// Appends the chords of the trajectory through one of them, from end to end, and tells why it ends there.
  std::array<StopReason, 2> trace(const ChordPlace& start, const Obstacles& obstacles, Chords& chords);

 private:
  StopReason walk(const Chord& start, Role exit, const Obstacles& obstacles, Chords& chords);
  bool comes_back(const Chord& chord, double arc);
  void prefetch(std::int32_t triangle, bool minds_others) const {
    __builtin_prefetch(crossings_.data() + triangle);
    visited_.prefetch(triangle);
    if (minds_others) occupancy_.stopped().prefetch(triangle);
  }

  const StreamlineTracer& tracer_;
  const ChordOccupancy& occupancy_;
  const Sheet& sheet_;
  const LargeArray<TriangleCrossings>& crossings_;
  double separation_;  // 0 where it varies
  double far_;         // from where on it is looked for what comes back
  VisitedChords visited_;
  SelfApproach passed_;  // points of the trajectory at hand
  bool has_passed_ = false;
  Chords backwards_;
};

}  // namespace pectinate::detail
