// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "detail/crossings.hpp"
#include "detail/large_array.hpp"

namespace pectinate::detail {

using TriangleMarks = std::vector<std::uint8_t>;  // not of bool: its bits take longer to get at

/// Marks triangles and those up to `rings` triangles away; the search does not go on beyond marked ones. Returns the
/// ring of unmarked ones around them, some of it twice.
inline std::vector<std::int32_t> mark_rings(const LargeArray<TriangleCrossings>& crossings,
                                            std::vector<std::int32_t> front, int rings, TriangleMarks& is_marked) {
  std::vector<std::int32_t> next;
  for (const auto t : front) is_marked[t] = 1;
  for (int ring = 0; ring <= rings; ++ring, front.swap(next)) {
    next.clear();
    for (const auto t : front) {
      for (const auto other : crossings[t].neighbours) {
        if (other < 0 || is_marked[other]) continue;
        if (ring < rings) is_marked[other] = 1;
        next.push_back(other);
      }
    }
  }
  return front;
}

}  // namespace pectinate::detail
