// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "detail/chord_occupancy.hpp"
#include "detail/trajectories.hpp"
#include "detail/vec.hpp"
#include "pectinate/surface_mesh.hpp"
#include "pectinate/tracing.hpp"

namespace pectinate::detail {

/// A streamline to be placed.
struct PlacedLine {
  std::vector<Vector> points;
  std::vector<std::int32_t> triangles;  ///< of the mesh, per segment
  std::vector<Vec3> barycentric;        ///< per point, in the triangle of the segment after it, or of the last
  double length = 0;
  std::array<StopReason, 2> stop_reasons{};
  ChordsAhead ahead;
};

/// Which lines there may be.
struct LineRules {
  double minimum_length;
  bool close_loops;  ///< closed curves of the field become closed lines
};

/// Places the longest streamline that still fits, again and again, until none does.
///
/// Calls `place` for each, and stops early when `go_on` says no; returns whether it
/// came to the end. Deterministic without random numbers. Ends always: every placed streamline takes chords of positive
/// measure, every seed that gives none is retired.
bool place_longest_first(const SurfaceMesh& mesh, const StreamlineTracer& tracer, const LineRules& rules,
                         ChordOccupancy& occupancy, const std::function<void(const PlacedLine&)>& place,
                         const std::function<bool()>& go_on);

}  // namespace pectinate::detail
