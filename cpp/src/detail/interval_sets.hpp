// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "detail/capsule.hpp"

namespace pectinate::detail {

/// For each of many items, a subset of [0, 1]: a union of closed intervals that only grows. Most are empty, all of
/// [0, 1], or one interval.
class IntervalSets {
 public:
  explicit IntervalSets(std::size_t count) : first_(count, empty) {}

  bool is_empty(std::int32_t item) const { return first_[item] == empty; }
  bool is_full(std::int32_t item) const { return first_[item] == full; }

  bool contains(std::int32_t item, double x) const { return contains(item, Interval{x, x}); }
  bool contains(std::int32_t item, const Interval& interval) const {
    auto node = first_[item];
    for (; node >= 0; node = nodes_[node].next) {
      if (interval.low >= nodes_[node].interval.low && interval.high <= nodes_[node].interval.high) return true;
    }
    return node == full;
  }

  void fill(std::int32_t item);
  /// Intervals that touch become one.
  void add(std::int32_t item, Interval interval);

  /// The intervals in ascending order.
  std::vector<Interval> intervals(std::int32_t item) const;
  /// The open gaps between them, in ascending order.
  std::vector<Interval> gaps(std::int32_t item) const;

 private:
  static constexpr std::int32_t empty = -1, full = -2;
  struct Node {
    Interval interval;
    std::int32_t next;
  };

  std::int32_t make_node(const Node& node);
  void release(std::int32_t node);

  std::vector<std::int32_t> first_;  // node, empty or full
  std::vector<Node> nodes_;
  std::int32_t released_ = empty;  // list of nodes for reuse
};

}  // namespace pectinate::detail
