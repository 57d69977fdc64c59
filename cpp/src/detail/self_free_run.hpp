// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "detail/vec.hpp"

namespace pectinate::detail {

struct SegmentRun {
  std::size_t first, last;  ///< segments [first, last)
};

/// For each segment of a polyline, with which segment the longest run that ends with it can begin, if no two of its
/// segments shall come nearer than `distance` with more than `arc_gap` of the line between them (paper section 2.6,
/// criterion 5, exact over whole segments).
std::vector<std::int32_t> self_free_starts(const std::vector<Vector>& points, double distance, double arc_gap);

/// The longest run of a polyline, or of a part of one: `starts` are those of the part's segments, length(i) is how long
/// they are, `before` is how many segments the whole has before it. Never empty, and all of what is free.
template <class Length>
SegmentRun longest_self_free_run(std::span<const std::int32_t> starts, std::int32_t before, const Length& length) {
  if (starts.back() <= before) return {0, starts.size()};  // whatever becomes of lengths that overflow or vanish
  SegmentRun run{0, 0}, longest = run;
  double run_length = 0, greatest = -1;
  for (; run.last < starts.size(); ++run.last) {
    run_length += length(run.last);
    const auto start = static_cast<std::size_t>(std::max(starts[run.last] - before, 0));
    for (; run.first < start; ++run.first) run_length -= length(run.first);
    if (run_length <= greatest) continue;
    longest = {run.first, run.last + 1};
    greatest = run_length;
  }
  return longest;
}

/// Is a closed polyline, whose last point is its first, free of such pairs, the line between them taken the shorter way
/// round?
bool is_self_free_loop(const std::vector<Vector>& points, double distance, double arc_gap);

}  // namespace pectinate::detail
