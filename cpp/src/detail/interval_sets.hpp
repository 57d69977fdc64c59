// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "detail/capsule.hpp"
#include "detail/large_array.hpp"

namespace pectinate::detail {

/// For each of many items, a subset of [0, 1]: a union of closed intervals. Most are empty, all of
/// [0, 1], or one interval.
///
/// Each item has a summary in sixteenths of [0, 1] that answers most questions. Ends are rounded outwards, to 2^-31: so
/// intervals take half the memory.
class IntervalSets {
 public:
  explicit IntervalSets(std::size_t count) : items_(large_array<Item>(count)) {
    nodes_.reserve(most_reserved * count);  // memory that is not written to costs nothing
  }

  bool is_empty(std::int32_t item) const { return items_[item].first == empty; }
  bool is_full(std::int32_t item) const { return items_[item].first == full; }

  bool contains(std::int32_t item, double x) const {
    const auto& [first, taken, touched] = items_[item];
    const int cell = std::clamp(static_cast<int>(x * cells), 0, cells - 1);
    if (taken >> cell & 1) return true;
    return (touched >> cell & 1) && contains(item, Interval{x, x});
  }
  bool contains(std::int32_t item, const Interval& interval) const {
    const double low = interval.low * units, high = interval.high * units;
    auto node = items_[item].first;
    for (; node >= 0; node = nodes_[node].next) {
      if (low >= nodes_[node].range.low && high <= nodes_[node].range.high) return true;
    }
    return node == full;
  }

  void prefetch(std::int32_t item) const { __builtin_prefetch(items_.data() + item); }

  void fill(std::int32_t item);
  void clear(std::int32_t item);
  /// Intervals that touch become one.
  void add(std::int32_t item, const Interval& interval);

  /// The intervals in ascending order.
  std::vector<Interval> intervals(std::int32_t item) const;
  /// The same, in memory that is there already.
  void get_intervals(std::int32_t item, std::vector<Interval>& result) const;
  /// The open gaps between them, in ascending order.
  std::vector<Interval> gaps(std::int32_t item) const;

 private:
  static constexpr std::int32_t empty = -1, full = -2;
  static constexpr std::size_t most_reserved = 4;  // nodes an item
  static constexpr double units = std::uint32_t{1} << 31;
  static constexpr int cells = 16, cell_bits = 27;  // units a cell
  /// In units.
  struct Range {
    std::uint32_t low, high;
  };
  struct Item {
    std::int32_t first = empty;            // node, empty or full
    std::uint16_t taken = 0, touched = 0;  // by cell: wholly, and at least partly
  };
  struct Node {
    Range range;
    std::int32_t next;
  };

  static Range range_around(const Interval& interval);
  static Interval interval_of(const Range& range) { return {range.low / units, range.high / units}; }
  std::int32_t make_node(const Range& range, std::int32_t next);
  void release(std::int32_t node);
  void release_all(std::int32_t node);

  LargeArray<Item> items_;
  LargeArray<Node> nodes_;
  std::int32_t released_ = empty;  // list of nodes for reuse
};

inline void IntervalSets::fill(std::int32_t item) {
  release_all(items_[item].first);
  items_[item] = {full, 0xffff, 0xffff};
}

inline void IntervalSets::clear(std::int32_t item) {
  release_all(items_[item].first);
  items_[item] = {};
}

/// What is no number reaches to the end.
inline IntervalSets::Range IntervalSets::range_around(const Interval& interval) {
  const double low = interval.low > 0 ? interval.low * units : 0,
               high = interval.high < 1 ? interval.high * units : units;
  const auto low_unit = static_cast<std::uint32_t>(low), high_unit = static_cast<std::uint32_t>(high);
  return {low_unit, high_unit + (high_unit < high)};
}

inline void IntervalSets::add(std::int32_t item, const Interval& interval) {
  if (is_full(item) || interval.high < 0 || interval.low > 1) return;
  auto range = range_around(interval);
  // Take out what it touches, then put in the union.
  auto before = empty;
  auto& [first, taken, touched] = items_[item];
  for (auto node = first; node >= 0;) {
    const auto& other = nodes_[node].range;
    const auto next = nodes_[node].next;
    if (other.low <= range.high && other.high >= range.low) {
      range = {std::min(range.low, other.low), std::max(range.high, other.high)};
      (before >= 0 ? nodes_[before].next : first) = next;
      release(node);
    } else {
      before = node;
    }
    node = next;
  }
  if (range.low == 0 && range.high == units) {
    fill(item);
  } else {
    first = make_node(range, first);
    // Cells [from, to), rounded inwards and outwards.
    const auto bits = [](unsigned from, unsigned to) {
      return static_cast<std::uint16_t>(from < to ? (1U << to) - (1U << from) : 0U);
    };
    const unsigned low = range.low >> cell_bits, high = range.high >> cell_bits;
    const bool begins_cell = low << cell_bits == range.low;
    taken |= bits(low + !begins_cell, high);
    touched |= bits(std::min(low, cells - 1U), std::min(high + 1U, 0U + cells));
  }
}

inline std::int32_t IntervalSets::make_node(const Range& range, std::int32_t next) {
  if (released_ < 0) {
    nodes_.push_back({range, next});
    return static_cast<std::int32_t>(nodes_.size()) - 1;
  }
  const auto index = released_;
  released_ = nodes_[index].next;
  nodes_[index] = {range, next};
  return index;
}

inline void IntervalSets::release(std::int32_t node) {
  nodes_[node].next = released_;
  released_ = node;
}

/// A node and those that follow it.
inline void IntervalSets::release_all(std::int32_t node) {
  while (node >= 0) {
    const auto next = nodes_[node].next;
    release(node);
    node = next;
  }
}

}  // namespace pectinate::detail
