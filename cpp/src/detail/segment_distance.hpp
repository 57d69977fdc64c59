// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>

#include "detail/capsule.hpp"
#include "detail/vec.hpp"

namespace pectinate::detail {

/// The distance between the segments from p to p_end and from q to q_end.
inline double segment_distance(const Vector& p, const Vector& p_end, const Vector& q, const Vector& q_end) {
  const double at_ends = std::min({distance_to_segment(p, q, q_end), distance_to_segment(p_end, q, q_end),
                                   distance_to_segment(q, p, p_end), distance_to_segment(q_end, p, p_end)});
  const Vector u = p_end - p, v = q_end - q, between = p - q;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > 1e-14 * uu * vv)) return at_ends;  // parallel: ends are nearest
  const double s = (uv * v.dot(between) - vv * u.dot(between)) / determinant;
  const double t = (uu * v.dot(between) - uv * u.dot(between)) / determinant;
  if (s <= 0 || s >= 1 || t <= 0 || t >= 1) return at_ends;
  return std::min(at_ends, (between + s * u - t * v).norm());
}

}  // namespace pectinate::detail
