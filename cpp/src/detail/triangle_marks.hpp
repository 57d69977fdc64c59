// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "detail/crossings.hpp"
#include "detail/large_array.hpp"

namespace pectinate::detail {

/// Marks on triangles, all of which can be forgotten at once.
class TriangleMarks {
 public:
  explicit TriangleMarks(std::size_t triangle_count) : rounds_(triangle_count, 0) {}

  bool has(std::int32_t triangle) const { return rounds_[triangle] == round_; }
  void add(std::int32_t triangle) { rounds_[triangle] = round_; }
  void clear() { ++round_; }

 private:
  LargeArray<std::uint32_t> rounds_;  // per triangle: when it was marked last
  std::uint32_t round_ = 1;
};

/// Marks triangles and those up to `rings` triangles away; the search does not go on beyond marked ones.
inline void mark_rings(const LargeArray<TriangleCrossings>& crossings, std::vector<std::int32_t> front, int rings,
                       TriangleMarks& marks) {
  for (const auto t : front) marks.add(t);
  std::vector<std::int32_t> next;
  for (; rings > 1; --rings, front.swap(next)) {
    next.clear();
    for (const auto t : front) {
      for (const auto other : crossings[t].neighbours) {
        if (other < 0 || marks.has(other)) continue;
        marks.add(other);
        next.push_back(other);
      }
    }
  }
  if (rings < 1) return;
  for (const auto t : front) {
    for (const auto other : crossings[t].neighbours) {
      if (other >= 0) marks.add(other);
    }
  }
}

}  // namespace pectinate::detail
