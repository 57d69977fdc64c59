// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "detail/vec.hpp"

namespace pectinate::detail {

/// Single precision, relative to an origin nearby.
struct FloatPoint {
  float x, y, z;
};
inline FloatPoint float_point(const Vector& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// Segments with capsules around them, laid out for questions to many of them at once.
struct Segments {
  static constexpr int group_size = 8, most = 16 * group_size;
  using Numbers = std::array<float, most>;

  alignas(64) Numbers x, y, z, dx, dy, dz;  ///< starts and axes
  Numbers length, inverse_square;           ///< of the axes
  Numbers reach;                            ///< radius of the capsule
  Numbers square;                           ///< of the distance from the point asked for last
  int count = 0;

  void add(const Vector& start, const Vector& axis, float capsule_reach);
  /// Whole groups: what is too many is far away.
  void fill_up();
  int padded_count() const { return (count + group_size - 1) / group_size * group_size; }
};

/// The distance from a point to the nearest segment; sets `square`.
float distance(Segments& segments, const FloatPoint& point);

/// From the point asked for last to the nearest capsule, whose radii are this share of `reach`; negative inside.
float distance_to_capsules(const Segments& segments, float share);

/// What is asked about the capsules near a triangle.
struct TriangleQuestion {
  std::array<FloatPoint, 3> corners;
  float radius;  ///< of a disc about the point asked for last that holds the triangle
  float share;   ///< radii of capsules, of `reach`
  float slack;   ///< more than single precision loses
};

/// The segments of one group for which something holds, by bit. Of those near: where the triangle lies before the
/// start, as seen along the segment, or beyond the end, only the ball there can meet it.
struct SegmentsNear {
  unsigned are_near;  ///< the capsule may enter the triangle's disc
  unsigned lie_before, lie_beyond;
};
SegmentsNear segments_near(const Segments& segments, int group, const TriangleQuestion& question);

}  // namespace pectinate::detail
