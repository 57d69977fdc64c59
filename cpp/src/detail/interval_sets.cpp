// SPDX-License-Identifier: MIT
#include "detail/interval_sets.hpp"

#include <algorithm>

namespace pectinate::detail {

void IntervalSets::fill(std::int32_t item) {
  for (auto node = first_[item]; node >= 0;) {
    const auto next = nodes_[node].next;
    release(node);
    node = next;
  }
  first_[item] = full;
}

void IntervalSets::add(std::int32_t item, Interval interval) {
  if (is_full(item)) return;
  // Take out what it touches, then put in the union.
  auto before = empty;
  for (auto node = first_[item]; node >= 0;) {
    const auto [other, next] = nodes_[node];
    if (other.low <= interval.high && other.high >= interval.low) {
      interval = {std::min(interval.low, other.low), std::max(interval.high, other.high)};
      (before >= 0 ? nodes_[before].next : first_[item]) = next;
      release(node);
    } else {
      before = node;
    }
    node = next;
  }
  if (interval.low <= 0 && interval.high >= 1) {
    fill(item);
  } else {
    first_[item] = make_node({interval, first_[item]});
  }
}

std::vector<Interval> IntervalSets::intervals(std::int32_t item) const {
  if (is_full(item)) return {{0, 1}};
  std::vector<Interval> result;
  for (auto node = first_[item]; node >= 0; node = nodes_[node].next) result.push_back(nodes_[node].interval);
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
