// SPDX-License-Identifier: MIT
#include "detail/interval_sets.hpp"

#include <algorithm>

namespace pectinate::detail {

std::vector<Interval> IntervalSets::intervals(std::int32_t item) const {
  std::vector<Interval> result;
  get_intervals(item, result);
  return result;
}

void IntervalSets::get_intervals(std::int32_t item, std::vector<Interval>& result) const {
  result.clear();
  if (is_full(item)) result.push_back({0, 1});
  for (auto node = items_[item].first; node >= 0; node = nodes_[node].next) {
    result.push_back(interval_of(nodes_[node].range));
  }
  std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.low < b.low; });
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

}  // namespace pectinate::detail
