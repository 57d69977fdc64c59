// SPDX-License-Identifier: MIT
#include "detail/triangle_measures.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace pectinate::detail {
#define PECTINATE_KERNEL "detail/triangle_measures_lanes.inl"
#include "detail/kernel_variants.inl"

void measure_areas(std::span<const Vec3> vertices, std::span<const Triangle> triangles, std::vector<double>& areas) {
  areas.resize(triangles.size());
  PECTINATE_CALL_KERNEL(measure_areas, vertices.data(), triangles, areas.data());
}

double measure_volume(std::span<const Vec3> vertices, std::span<const Triangle> triangles, const Vec3& apex) {
  return PECTINATE_CALL_KERNEL(measure_volume, vertices.data(), triangles, apex);
}

}  // namespace pectinate::detail
