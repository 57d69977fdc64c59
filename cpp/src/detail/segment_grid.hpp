// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "detail/buckets.hpp"
#include "detail/vec.hpp"

namespace pectinate::detail {

/// Finds segments in space by the cells through which they pass. First all are added, then they are looked for.
class SegmentGrid {
 public:
  /// For what is at most `reach` apart.
  explicit SegmentGrid(double reach) : pieces_per_length_(2 / reach), cells_per_length_(1 / (1.5 * reach)) {}

  void add(std::int64_t segment, const Vector& start, const Vector& end) {
    visit_pieces(start, end, [&](const Vector& middle) { entries_.push_back({segment, key(cell_of(middle))}); });
  }
  void finish() {
    const auto count = std::bit_ceil(entries_.size() + 1);
    by_cell_ = Buckets<Entry>(entries_, count, [count](const Entry& entry) { return entry.key & (count - 1); });
    entries_ = {};
  }

  /// Calls visit(segment) for all that are near a segment and some others, some of them again and again.
  template <class Visit>
  void visit_near(const Vector& start, const Vector& end, const Visit& visit) {
    visit_pieces(start, end, [&](const Vector& middle) {
      const auto [x, y, z] = cell_of(middle);
      for (auto i = x - 1; i <= x + 1; ++i) {
        for (auto j = y - 1; j <= y + 1; ++j) {
          for (auto k = z - 1; k <= z + 1; ++k) visit_cell(key({i, j, k}), visit);
        }
      }
    });
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Entry {
    std::int64_t segment;
    std::uint64_t key;  // of its cell, or of few others too
  };

  /// Pieces no longer than half the reach: two that are near have their middles at most 1.5 reaches, a cell's side,
  /// apart.
  template <class Visit>
  void visit_pieces(const Vector& start, const Vector& end, const Visit& visit) const {
    const auto count = 1 + floor((end - start).norm() * pieces_per_length_);
    const Vector step = (end - start) / static_cast<double>(count);
    for (std::int64_t i = 0; i < count; ++i) visit(Vector(start + (static_cast<double>(i) + 0.5) * step));
  }

  Cell cell_of(const Vector& place) const {
    const Vector scaled = place * cells_per_length_;
    return {floor(scaled.x()), floor(scaled.y()), floor(scaled.z())};
  }

  static std::int64_t floor(double x) {
    const auto towards_zero = static_cast<std::int64_t>(x);
    return towards_zero - (x < static_cast<double>(towards_zero));
  }

  static std::uint64_t key(const Cell& cell) {
    std::uint64_t key = 0;
    for (const auto index : cell) key = (key ^ static_cast<std::uint64_t>(index)) * 0x9e3779b97f4a7c15U;
    return key ^ key >> 32;
  }

  template <class Visit>
  void visit_cell(std::uint64_t key, const Visit& visit) {
    for (const auto& entry : by_cell_.bucket(key & (by_cell_.count() - 1))) {
      if (entry.key == key) visit(entry.segment);
    }
  }

  double pieces_per_length_, cells_per_length_;
  std::vector<Entry> entries_;
  Buckets<Entry> by_cell_{{}, 1, [](const Entry&) { return 0; }};
};

}  // namespace pectinate::detail
