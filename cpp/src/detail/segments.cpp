// SPDX-License-Identifier: MIT
#include "detail/segments.hpp"

#include <algorithm>
#include <cmath>

namespace pectinate::detail {

#define PECTINATE_KERNEL "detail/segments_lanes.inl"
#include "detail/kernel_variants.inl"

void Segments::add(const Vector& start, const Vector& axis, float capsule_reach) {
  const auto place = float_point(start), along = float_point(axis);
  x[count] = place.x, y[count] = place.y, z[count] = place.z;
  dx[count] = along.x, dy[count] = along.y, dz[count] = along.z;
  const double square_length = axis.squaredNorm();
  length[count] = static_cast<float>(std::sqrt(square_length));
  inverse_square[count] = static_cast<float>(square_length > 1e-30 ? 1 / square_length : 0);
  reach[count] = capsule_reach;
  ++count;
}

void Segments::fill_up() {
  for (int i = count; i < padded_count(); ++i) {
    x[i] = y[i] = z[i] = 1e15F;
    dx[i] = dy[i] = dz[i] = length[i] = inverse_square[i] = reach[i] = 0;
  }
}

float distance(Segments& segments, const FloatPoint& point) {
  return PECTINATE_CALL_KERNEL(distance, segments, point);
}

float distance_to_capsules(const Segments& segments, float share) {
  float nearest = 1e30F;
  for (int i = 0; i < segments.count; ++i) {
    nearest = std::min(nearest, std::sqrt(segments.square[i]) - share * segments.reach[i]);
  }
  return nearest;
}

SegmentsNear segments_near(const Segments& segments, int group, const TriangleQuestion& question) {
  return PECTINATE_CALL_KERNEL(segments_near, segments, group, question);
}

}  // namespace pectinate::detail
