// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "detail/chord_occupancy.hpp"
#include "pectinate/surface_mesh.hpp"
#include "pectinate/tracing.hpp"

namespace pectinate::detail {

/// Places the longest streamline that still fits, again and again, until none does.
///
/// None shorter than `minimum_length`. Calls `place` for each, and stops early when `go_on` says no; returns whether it
/// came to the end. Deterministic without random numbers. Ends always: every placed streamline takes chords of positive
/// measure, every seed that gives none is retired.
bool place_longest_first(const SurfaceMesh& mesh, const StreamlineTracer& tracer, double minimum_length,
                         ChordOccupancy& occupancy, const std::function<void(const Streamline&)>& place,
                         const std::function<bool()>& go_on);

}  // namespace pectinate::detail
