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
  /// Of a stretch of a trajectory, the longest part that keeps criterion 5 at a separation distance; points() are those
  /// of the stretch, asked for if it is not known.
  template <class Points>
  Stretch longest(const Stretch& stretch, std::int32_t trajectory, double separation, const Chords& chords,
                  const Points& points) {
    const auto found = trajectories_.find(trajectory);
    if (found != trajectories_.end() && found->second.covers(stretch, separation)) {
      return longest(stretch, found->second, chords);
    }
    Known known{stretch, separation, self_free_starts(points(), separation, 2 * separation)};
    const auto part = longest(stretch, known, chords);
    if (part != stretch) trajectories_[trajectory] = std::move(known);
    return part;
  }

  /// When trajectories get other numbers or places.
  void forget() { trajectories_.clear(); }

 private:
  struct Known {
    Stretch stretch{0, 0};
    double separation = 0;
    std::vector<std::int32_t> starts;

    bool covers(const Stretch& other, double distance) const {
      return distance == separation && other.first >= stretch.first && other.last <= stretch.last;
    }
  };

  static Stretch longest(const Stretch& stretch, const Known& known, const Chords& chords) {
    const auto before = stretch.first - known.stretch.first, count = stretch.last - stretch.first;
    const auto length = [&](std::size_t i) { return chords[static_cast<std::size_t>(stretch.first) + i].length; };
    const auto run = longest_self_free_run(std::span(known.starts).subspan(before, count),
                                           static_cast<std::int32_t>(before), length);
    return {stretch.first + static_cast<std::int64_t>(run.first), stretch.first + static_cast<std::int64_t>(run.last)};
  }

  std::unordered_map<std::int32_t, Known> trajectories_;  // those that come back to themselves
};

}  // namespace pectinate::detail
