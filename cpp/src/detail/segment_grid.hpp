// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "detail/vec.hpp"

namespace pectinate::detail {

/// Finds segments in space by the cells through which they pass. Cells are told by a hash, which few share: so it takes
/// eight to sixteen bytes a segment.
class SegmentGrid {
 public:
  /// For what is at most `reach` apart. `visit_all(add)` calls add(segment, start, end) for all, twice the same;
  /// `total_length` is theirs.
  template <class VisitAll>
  SegmentGrid(double reach, std::size_t count, double total_length, const VisitAll& visit_all) {
    // Short segments are soon found in small cells, of long ones there would be too many pieces.
    const double mean = total_length / static_cast<double>(count);
    const double piece = mean < reach / 2 ? reach / 2 : std::max(reach, mean / most_pieces);
    pieces_per_length_ = 1 / piece;
    cells_per_length_ = 1 / (reach + piece);
    const auto about = count + static_cast<std::size_t>(total_length * pieces_per_length_);
    ends_.resize(std::bit_ceil(about + 1) + 1, 0);
    const auto visit_buckets = [&](const auto& visit) {
      visit_all([&](std::uint32_t segment, const Vector& start, const Vector& end) {
        const auto pieces = piece_count(start, end);
        for (std::int64_t i = 0; i < pieces; ++i) {
          visit(segment, ends_[bucket(cell_of(middle(start, end, i, pieces)))]);
        }
      });
    };
    visit_buckets([](std::uint32_t, std::uint32_t& end) { ++end; });
    std::uint32_t sum = 0;  // each end comes to lie at its bucket's begin, and moves back to its place
    for (auto& end : ends_) sum += std::exchange(end, sum);
    segments_.resize(sum);
    visit_buckets([&](std::uint32_t segment, std::uint32_t& end) { segments_[end++] = segment; });
  }

  /// Calls visit(segment) for all that are near a segment and some others, some of them again and again; piece by
  /// piece, as long as is_wanted(share of the way) says so.
  template <class IsWanted, class Visit>
  void visit_near(const Vector& start, const Vector& end, const IsWanted& is_wanted, const Visit& visit) const {
    const auto count = piece_count(start, end);
    for (std::int64_t piece = 0; piece < count; ++piece) {
      if (!is_wanted(static_cast<double>(piece) / static_cast<double>(count))) return;
      const auto [x, y, z] = cell_of(middle(start, end, piece, count));
      for (auto i = x - 1; i <= x + 1; ++i) {
        for (auto j = y - 1; j <= y + 1; ++j) {
          for (auto k = z - 1; k <= z + 1; ++k) visit_bucket(bucket({i, j, k}), visit);
        }
      }
    }
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  static constexpr double most_pieces = 8;  // of a segment, on average

  /// Pieces so short that two that are near have their middles at most a cell's side apart.
  std::int64_t piece_count(const Vector& start, const Vector& end) const {
    return 1 + floor((end - start).norm() * pieces_per_length_);
  }
  static Vector middle(const Vector& start, const Vector& end, std::int64_t piece, std::int64_t count) {
    return start + (static_cast<double>(piece) + 0.5) / static_cast<double>(count) * (end - start);
  }

  Cell cell_of(const Vector& place) const {
    const Vector scaled = place * cells_per_length_;
    return {floor(scaled.x()), floor(scaled.y()), floor(scaled.z())};
  }

  static std::int64_t floor(double x) {
    const auto towards_zero = static_cast<std::int64_t>(x);
    return towards_zero - (x < static_cast<double>(towards_zero));
  }

  std::size_t bucket(const Cell& cell) const {
    std::uint64_t key = 0;
    for (const auto index : cell) key = (key ^ static_cast<std::uint64_t>(index)) * 0x9e3779b97f4a7c15U;
    return (key ^ key >> 32) & (ends_.size() - 2);
  }

  template <class Visit>
  void visit_bucket(std::size_t bucket, const Visit& visit) const {
    for (auto i = bucket == 0 ? 0 : ends_[bucket - 1]; i < ends_[bucket]; ++i) visit(segments_[i]);
  }

  double pieces_per_length_, cells_per_length_;
  std::vector<std::uint32_t> ends_;      // per bucket: where its segments end
  std::vector<std::uint32_t> segments_;  // bucket after bucket
};

}  // namespace pectinate::detail
