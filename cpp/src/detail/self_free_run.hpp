// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "detail/vec.hpp"

namespace pectinate::detail {

struct SegmentRun {
  std::size_t first, last;  ///< segments [first, last)
};

/// The longest run of a polyline's segments in which no two come nearer than `distance` with more than `arc_gap` of
/// the line between them (paper section 2.6, criterion 5, exact over whole segments).
SegmentRun longest_self_free_run(const std::vector<Vector>& points, double distance, double arc_gap);

/// Is a closed polyline, whose last point is its first, free of such pairs, the line between them taken the shorter way
/// round?
bool is_self_free_loop(const std::vector<Vector>& points, double distance, double arc_gap);

}  // namespace pectinate::detail
