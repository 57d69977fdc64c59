// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "detail/sheet.hpp"
#include "detail/trajectories.hpp"

namespace pectinate::detail {

/// The closed curves of the field on which one winds that starts with a chord and came near itself within so many
/// triangles. Each begins where it ends, within rounding: 1e-9 of the chord coordinate.
///
/// From a triangle along a strip of triangles back to it the chord coordinate changes affinely, s -> a s + b; the fixed
/// point is a closed curve as long as it keeps to a strip that comes back. The search goes from fixed point to fixed
/// point, which is Newton's method on that piecewise affine map, or once more round, to where the map attracts.
/// Where a < 0, about the core of a Moebius strip, both the core and the curve that closes after two turns are found.
std::vector<Chords> closed_orbits(const Sheet& sheet, const Chord& start, std::int64_t triangle_count);

/// Is a closed polyline, whose last point is its first, long enough for a streamline, and are parts of it that are more
/// than 2 `distance` apart along it, the shorter way round, never nearer than `distance`?
bool keeps_from_itself(const std::vector<Vector>& points, double distance);

}  // namespace pectinate::detail
