// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "detail/self_free_run.hpp"
#include "detail/trajectories.hpp"

namespace pectinate::detail {

/// Finds parts of trajectories that do not come back to themselves. Where a trajectory does takes long to find, and
/// many stretches of it are asked for: so it is kept.
class SelfFreeParts {
 public:
  /// Of a stretch of a trajectory, the longest part that keeps criterion 5 at a separation distance; `points` are those
  /// of the stretch.
  Stretch longest(const Stretch& stretch, std::int32_t trajectory, const std::vector<Vector>& points,
                  double separation) {
    auto& known = trajectories_[trajectory];
    if (known.separation != separation || stretch.first < known.stretch.first || stretch.last > known.stretch.last) {
      known = {stretch, separation, self_free_starts(points, separation, 2 * separation)};
    }
    const auto before = stretch.first - known.stretch.first;
    const auto run =
        longest_self_free_run(points, std::span(known.starts).subspan(before), static_cast<std::int32_t>(before));
    const Stretch part{stretch.first + static_cast<std::int64_t>(run.first),
                       stretch.first + static_cast<std::int64_t>(run.last)};
    if (part.last - part.first == stretch.last - stretch.first) trajectories_.erase(trajectory);
    return part;
  }

  /// When trajectories get other numbers or places.
  void forget() { trajectories_.clear(); }

 private:
  struct Known {
    Stretch stretch{0, 0};
    double separation = 0;
    std::vector<std::int32_t> starts;
  };
  std::unordered_map<std::int32_t, Known> trajectories_;  // those that come back to themselves
};

}  // namespace pectinate::detail
