// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "detail/chord_occupancy.hpp"
#include "detail/chord_tracer.hpp"
#include "detail/placed_lines.hpp"
#include "detail/trajectories.hpp"
#include "pectinate/surface_mesh.hpp"
#include "pectinate/tracing.hpp"

namespace pectinate::detail {

/// What lines left free when they were taken out of a full surface, and how it is filled again.
struct FreedRegion {
  std::vector<std::int32_t> triangles;              ///< where candidates start, in this order
  std::vector<ChordPlace> first;                    ///< through these lines are placed before all others
  std::function<double(const Interval&)> start_in;  ///< where in a gap a candidate starts
};

/// Places the longest streamline that still fits, again and again, until none does.
///
/// Calls `place` for each. Deterministic without random numbers. Ends always: every placed streamline takes chords of
/// positive measure, every seed that gives none is retired.
class LineFiller {
 public:
  using Place = std::function<void(const PlacedLine&)>;
  /// Marks what a line takes; returns the triangles in which that may have changed the occupancy.
  using Mark = std::function<const std::vector<std::int32_t>&(const Polyline&)>;

  LineFiller(const SurfaceMesh& mesh, const StreamlineTracer& tracer, const LineRules& rules, ChordOccupancy& occupancy,
             Place place);
  ~LineFiller();

  /// Stops early when `go_on` says no; returns whether it came to the end.
  bool fill(const std::function<bool()>& go_on);

  /// Instead of `ChordOccupancy::add`.
  void mark_with(Mark mark);
  /// Fills what was freed.
  void refill(const FreedRegion& freed);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace pectinate::detail
