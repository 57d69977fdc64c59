// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "detail/capsule.hpp"
#include "detail/sheet.hpp"
#include "pectinate/surface_mesh.hpp"

namespace pectinate::detail {

/// Chords of a triangle of the sheet.
struct ChordRange {
  std::int32_t triangle;
  Interval chords;
};

/// The chords that come nearer than `radius` to one of these mesh vertices, in the triangles that are joined to it on
/// the surface through triangles that near. Rounding is on the safe side.
std::vector<ChordRange> chords_near_vertices(const SurfaceMesh& mesh, const Sheet& sheet,
                                             const std::vector<std::int32_t>& vertices, double radius);

}  // namespace pectinate::detail
