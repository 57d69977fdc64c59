// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "detail/sheet.hpp"
#include "detail/trajectories.hpp"

namespace pectinate::detail {

/// A closed curve of the field on which one winds that starts with a chord and came near itself within so many
/// triangles; empty if none is found. It begins where it ends, within 2e-9 of its length, and crosses one of its
/// triangles only once in the same sense.
///
/// From a triangle along a strip of triangles back to it the chord coordinate changes affinely, s -> a s + b. The fixed
/// point is a closed curve if it keeps to the strip, or to another one that comes back: from strip to strip that is
/// Newton's method on a piecewise affine map. The curve is followed on, and whenever it comes back to a triangle nearer
/// to a fixed point than before, that is tried.
Chords closed_orbit(const Sheet& sheet, const Chord& start, std::int64_t triangle_count);

/// Is a closed polyline, whose last point is its first, long enough for a streamline, and are parts of it that are more
/// than 2 `distance` apart along it, the shorter way round, never nearer than `distance`?
bool keeps_from_itself(const std::vector<Vector>& points, double distance);

}  // namespace pectinate::detail
