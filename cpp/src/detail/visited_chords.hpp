// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>

#include "detail/large_array.hpp"

namespace pectinate::detail {

/// The chords by which a growing streamline crossed each triangle last. Around a vortex smaller than d_sep a streamline
/// can wind for ever without two of its points being 2 d_sep apart along it, as criterion 5 asks: coming back to a
/// triangle nearer than d_sep ends it too.
class VisitedChords {
 public:
  /// Forgets all visits.
  void start(std::size_t triangle_count) {
    ++round_;
    if (visits_.size() == triangle_count && round_ != 0) return;
    visits_.assign(triangle_count, {0, 0});
    round_ = 1;
  }

  /// Notes a visit; was the triangle, so wide across the field, crossed before at less than `distance` from it?
  bool revisit(std::int32_t triangle, double chord, double width, double distance) {
    auto& last = visits_[triangle];
    const bool is_near = last.round == round_ && std::abs(last.chord - chord) * width < distance;
    last = {static_cast<float>(chord), round_};
    return is_near;
  }

  void prefetch(std::int32_t t) const { __builtin_prefetch(visits_.data() + t, 1); }

 private:
  struct Visit {
    float chord;
    std::uint32_t round;
  };
  std::uint32_t round_ = 0;
  LargeArray<Visit> visits_;
};

}  // namespace pectinate::detail
