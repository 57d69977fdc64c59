// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "pectinate/types.hpp"

namespace pectinate::detail {

/// Areas of triangles; NaN where one is degenerate, which it also is where a corner is not finite or is repeated.
void measure_areas(std::span<const Vec3> vertices, std::span<const Triangle> triangles, std::vector<double>& areas);

/// Six times the volume between triangles and an apex, summed up in their order; negative where they turn to it.
double measure_volume(std::span<const Vec3> vertices, std::span<const Triangle> triangles, const Vec3& apex);

}  // namespace pectinate::detail
