// SPDX-License-Identifier: MIT
#include "detail/self_free_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "detail/segment_distance.hpp"

namespace pectinate::detail {
namespace {

/// Segments sorted by the cell of their midpoint, in a grid so coarse that near segments lie in neighbouring cells.
class SegmentGrid {
 public:
  SegmentGrid(const std::vector<Vector>& points, double cell_size) : points_(points), cell_size_(cell_size) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) entries_.push_back({key(cell_of(i)), i});
    std::sort(entries_.begin(), entries_.end());
  }

  /// Calls visit(segment) for all segments in the cells around that of one.
  template <class Visit>
  void visit_around(std::size_t segment, const Visit& visit) {
    find_rows(cell_of(segment));
    for (const auto& [first, last] : rows_) {
      for (auto entry = first; entry != last; ++entry) visit(entry->segment);
    }
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct Entry {
    std::uint64_t key;
    std::size_t segment;
    auto operator<=>(const Entry&) const = default;
  };

  /// Neighbours along z have consecutive keys. Far apart cells may share one: that costs time, nothing else.
  static std::uint64_t key(const Cell& cell) {
    constexpr std::uint64_t mask = (1 << 21) - 1, middle = 1 << 20;
    const auto bits = [&](std::int64_t c) { return (static_cast<std::uint64_t>(c) + middle) & mask; };
    return bits(cell[0]) << 42 | bits(cell[1]) << 21 | bits(cell[2]);
  }

  Cell cell_of(std::size_t segment) const {
    const Vector middle = (points_[segment] + points_[segment + 1]) / 2 - points_[0];
    const auto index = [&](double x) { return static_cast<std::int64_t>(std::floor(x / cell_size_)); };
    return {index(middle.x()), index(middle.y()), index(middle.z())};
  }

  /// Looks up the three by three rows of cells around one; neighbours along the line mostly share them.
  void find_rows(const Cell& cell) {
    if (rows_cell_ == cell) return;
    rows_cell_ = cell;
    for (std::int64_t i = 0; i < 9; ++i) {
      const auto first = key({cell[0] + i % 3 - 1, cell[1] + i / 3 - 1, cell[2] - 1});
      const auto start = std::lower_bound(entries_.begin(), entries_.end(), Entry{first, 0});
      auto end = start;
      while (end != entries_.end() && end->key <= first + 2) ++end;
      rows_[i] = {start, end};
    }
  }

  const std::vector<Vector>& points_;
  double cell_size_;
  std::vector<Entry> entries_;
  std::optional<Cell> rows_cell_;
  std::array<std::pair<std::vector<Entry>::const_iterator, std::vector<Entry>::const_iterator>, 9> rows_;
};

}  // namespace

SegmentRun longest_self_free_run(const std::vector<Vector>& points, double distance, double arc_gap) {
  const auto count = points.size() - 1;
  std::vector<double> arc{0};
  double longest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double length = (points[i + 1] - points[i]).norm();
    longest = std::max(longest, length);
    arc.push_back(arc.back() + length);
  }
  if (arc.back() <= arc_gap) return {0, count};

  SegmentGrid grid(points, distance + longest);
  SegmentRun best{0, 0};
  // Two pointers: the run that ends with segment `last` cannot begin before `first`.
  std::size_t first = 0;
  for (std::size_t last = 0; last < count; ++last) {
    if (arc[last] - arc[first + 1] > arc_gap) {
      grid.visit_around(last, [&](std::size_t i) {
        if (i < first || i >= last || arc[last] - arc[i + 1] <= arc_gap) return;
        if (segment_distance(points[i], points[i + 1], points[last], points[last + 1]) < distance) first = i + 1;
      });
    }
    if (arc[last + 1] - arc[first] > arc[best.last] - arc[best.first]) best = {first, last + 1};
  }
  return best;
}

}  // namespace pectinate::detail
