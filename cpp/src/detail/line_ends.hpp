// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "detail/trajectories.hpp"
#include "pectinate/placement.hpp"
#include "pectinate/tracing.hpp"

namespace pectinate::detail {

/// Lets streamlines run on into the chords ahead, one after the other, as far as they keep `clearance` separation
/// distances from all others, whether on the surface or in space, and d_sep from their own parts (criterion 5).
/// Occupancy and criterion 5 know whole chords only: of the last one a part is free, as a rule.
void extend_ends(const StreamlineTracer& tracer, double clearance, const std::vector<ChordsAhead>& ahead,
                 Placement& placement);

}  // namespace pectinate::detail
