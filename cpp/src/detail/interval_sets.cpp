// SPDX-License-Identifier: MIT
#include "detail/interval_sets.hpp"

#include <algorithm>

namespace pectinate::detail {

void IntervalSets::fill(std::int32_t item) {
  for (auto node = items_[item].first; node >= 0;) {
    const auto next = nodes_[node].next;
    release(node);
    node = next;
  }
  items_[item] = {full, 0xffff, 0xffff};
}

void IntervalSets::add(std::int32_t item, Interval interval) {
  if (is_full(item)) return;
  // Take out what it touches, then put in the union.
  auto before = empty;
  auto& [first, taken, touched] = items_[item];
  for (auto node = first; node >= 0;) {
    const auto [other, next] = nodes_[node];
    if (other.low <= interval.high && other.high >= interval.low) {
      interval = {std::min(interval.low, other.low), std::max(interval.high, other.high)};
      (before >= 0 ? nodes_[before].next : first) = next;
      release(node);
    } else {
      before = node;
    }
    node = next;
  }
  if (interval.low <= 0 && interval.high >= 1) {
    fill(item);
  } else {
    first = make_node({interval, first});
    // Cells [low, high), rounded inwards and outwards; a power of two scales exactly.
    const auto bits = [](int from, int to) {
      return static_cast<std::uint16_t>(from < to ? (1U << to) - (1U << from) : 0U);
    };
    const double low = std::max(interval.low, 0.0) * cells, high = std::min(interval.high, 1.0) * cells;
    const int low_cell = static_cast<int>(low), high_cell = static_cast<int>(high);
    taken |= bits(low_cell + (low > low_cell), high_cell);
    touched |= bits(std::min(low_cell, cells - 1), std::min(high_cell + 1, cells));
  }
}

std::vector<Interval> IntervalSets::intervals(std::int32_t item) const {
  if (is_full(item)) return {{0, 1}};
  std::vector<Interval> result;
  for (auto node = items_[item].first; node >= 0; node = nodes_[node].next) result.push_back(nodes_[node].interval);
  std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.low < b.low; });
  return result;
}

std::vector<Interval> IntervalSets::gaps(std::int32_t item) const {
  std::vector<Interval> result;
  double reached = 0;
  for (const auto& interval : intervals(item)) {
    if (interval.low > reached) result.push_back({reached, interval.low});
    reached = std::max(reached, interval.high);
  }
  if (reached < 1) result.push_back({reached, 1});
  return result;
}

std::int32_t IntervalSets::make_node(const Node& node) {
  if (released_ < 0) {
    nodes_.push_back(node);
    return static_cast<std::int32_t>(nodes_.size()) - 1;
  }
  const auto index = released_;
  released_ = nodes_[index].next;
  nodes_[index] = node;
  return index;
}

void IntervalSets::release(std::int32_t node) {
  nodes_[node].next = released_;
  released_ = node;
}

}  // namespace pectinate::detail
