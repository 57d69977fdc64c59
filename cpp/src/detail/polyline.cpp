// SPDX-License-Identifier: MIT
#include "detail/polyline.hpp"

#include "detail/chord_sides.hpp"

namespace pectinate::detail {

void Polyline::follow(const Sheet& sheet, std::span<const Chord> along, bool is_closed) {
  points.clear();
  triangles.clear();
  chords.clear();
  visit_points(sheet, along, is_closed, [&](const Vector& point) { points.push_back(point); });
  for (const auto& chord : along) {
    triangles.push_back(chord.triangle());
    chords.push_back(chord.coordinate);
  }
}

}  // namespace pectinate::detail
