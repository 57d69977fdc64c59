// SPDX-License-Identifier: MIT
// What triangle_measures.cpp compiles once for each kind of processor.

#include "detail/lane_triangles.inl"

/// Below this height over the longest side a triangle has no usable plane in double precision.
constexpr double least_relative_height = 1e-8;

inline void measure_areas(const Vec3* vertices, std::span<const Triangle> triangles, double* areas) {
  for (std::size_t first = 0; first < triangles.size(); first += doubles) {
    const auto [a, b, c] = gather_triangles(vertices, triangles, first);
    const LaneVector ab = b - a, ac = c - a, bc = ac - ab, normal = cross(ab, ac);
    const Lanes longest = greatest(greatest(dot(ab, ab), dot(ac, ac)), dot(bc, bc));
    const Lanes twice_area = root(dot(normal, normal));
    const Mask is_usable =
        (twice_area > least_relative_height * longest) & (twice_area <= std::numeric_limits<double>::max());
    const Lanes area = is_usable ? twice_area / 2 : all(std::numeric_limits<double>::quiet_NaN());
    for (int lane = 0; lane < doubles && first + lane < triangles.size(); ++lane) areas[first + lane] = area[lane];
  }
}

inline double measure_volume(const Vec3* vertices, std::span<const Triangle> triangles, const Vec3& apex) {
  const LaneVector from{all(apex[0]), all(apex[1]), all(apex[2])};
  double sum = 0;
  for (std::size_t first = 0; first < triangles.size(); first += doubles) {
    const auto [a, b, c] = gather_triangles(vertices, triangles, first);
    const Lanes volume = dot(a - from, cross(b - a, c - a));
    for (int lane = 0; lane < doubles && first + lane < triangles.size(); ++lane) sum += volume[lane];
  }
  return sum;
}
