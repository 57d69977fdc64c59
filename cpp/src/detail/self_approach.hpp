// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "detail/vec.hpp"

namespace pectinate::detail {

/// Tells whether a growing streamline comes back to itself (paper section 2.6, criterion 5): two of its points closer
/// than `distance` in space and more than twice as far apart along it. A hash grid with cells of that size.
class SelfApproach {
 public:
  /// Forgets all points. `origin` is any point near the streamline.
  void start(double distance, const Vector& origin);

  /// Is there a point that is too close to this one? `arc` is the signed length from the seed.
  bool is_near(const Vector& point, double arc) const;
  void add(const Vector& point, double arc);

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Entry {
    Vector point;
    double arc;
    std::int32_t next;  // in the same slot
  };

  Cell cell_of(const Vector& point) const;
  std::size_t slot_of(const Cell& cell) const;
  void grow();

  double distance_ = 0;
  Vector origin_ = Vector::Zero();
  double least_arc_ = 0, greatest_arc_ = 0;
  std::vector<Entry> entries_;
  std::vector<std::int32_t> slots_;  // first entry, or -1
};

}  // namespace pectinate::detail
