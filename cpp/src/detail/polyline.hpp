// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "detail/sheet.hpp"
#include "detail/trajectories.hpp"
#include "detail/vec.hpp"

namespace pectinate::detail {

/// A polyline whose segment i lies in triangle i of the sheet, on the chord with coordinate i.
struct Polyline {
  std::vector<Vector> points;
  std::vector<std::int32_t> triangles;
  std::vector<double> chords;

  /// Becomes that along these chords.
  void follow(const Sheet& sheet, std::span<const Chord> along, bool is_closed);
};

}  // namespace pectinate::detail
