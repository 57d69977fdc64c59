// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "detail/crossings.hpp"
#include "detail/large_array.hpp"

namespace pectinate::detail {

/// Marks triangles and those up to `rings` triangles away; the search does not go on beyond marked ones.
inline void mark_rings(const LargeArray<TriangleCrossings>& crossings, std::vector<std::int32_t> front, int rings,
                       std::vector<bool>& is_marked) {
  std::vector<std::int32_t> next;
  for (const auto t : front) is_marked[t] = true;
  for (int ring = 0; ring < rings; ++ring, front.swap(next)) {
    next.clear();
    for (const auto t : front) {
      for (const auto other : crossings[t].neighbours) {
        if (other < 0 || is_marked[other]) continue;
        is_marked[other] = true;
        next.push_back(other);
      }
    }
  }
}

}  // namespace pectinate::detail
