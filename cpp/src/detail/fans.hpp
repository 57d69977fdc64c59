// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "detail/scratch.hpp"
#include "pectinate/surface_mesh.hpp"

namespace pectinate::detail {

using Neighbours = std::vector<std::array<PackedNeighbour, 3>>;

/// A triangle's corner.
struct Corner {
  std::int32_t triangle;
  int corner;

  bool operator==(const Corner&) const = default;
};

/// A triangle's side seen from one of its ends: it leaves the vertex or arrives there.
class FanSide {
 public:
  FanSide(std::int32_t triangle, int side, bool leaves) : triangle_(triangle), side_(side), leaves_(leaves) {}

  std::int32_t triangle() const { return triangle_; }
  int side() const { return side_; }
  bool leaves() const { return leaves_; }
  Corner corner() const { return {triangle_, leaves_ ? side_ : next(side_)}; }
  PackedNeighbour across(const Neighbours& neighbours) const { return neighbours[triangle_][side_]; }
  /// The other side at the vertex of the triangle across.
  FanSide beyond(PackedNeighbour across) const {
    // Where the sides run the same way round, the one there leaves the vertex if this one does.
    const bool leaves_there = leaves_ == across.runs_alike();
    return {across.triangle(), leaves_there ? next(next(across.side())) : next(across.side()), !leaves_there};
  }

 private:
  static int next(int k) { return k == 2 ? 0 : k + 1; }

  std::int32_t triangle_;
  int side_;
  bool leaves_;
};

/// Calls visit(corner) for all corners of the fan of triangles around a vertex, given one of them: across the sides
/// that are joined, until a border or once round.
template <class Visit>
void visit_fan(const Neighbours& neighbours, const Corner& start, const Visit& visit) {
  visit(start);
  for (auto side :
       {FanSide{start.triangle, start.corner, true}, FanSide{start.triangle, (start.corner + 2) % 3, false}}) {
    for (auto across = side.across(neighbours); across.exists(); across = side.across(neighbours)) {
      side = side.beyond(across);
      if (side.triangle() == start.triangle) return;
      visit(side.corner());
    }
  }
}

/// Do the triangles at each vertex form one fan? No two of them may have the same corners. `border_triangles` has
/// all triangles with a side at a border; others do no harm.
bool has_one_fan_everywhere(const std::vector<Triangle>& triangles, const Neighbours& neighbours,
                            const std::vector<std::int32_t>& border_triangles, std::size_t vertex_count,
                            Scratch& scratch);

}  // namespace pectinate::detail
