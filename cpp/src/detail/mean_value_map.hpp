// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pectinate/parameterization.hpp"

namespace pectinate::detail {

/// Whether `mean_value_map` is more than a message.
bool has_mean_value_map();

/// Maps a topological disk to the unit disk: `border` (vertices in order, the surface on their left) to the circle in
/// proportion to its edge lengths, its first vertex to (1, 0), every other vertex to the average of its neighbours
/// under mean value weights. Per vertex. Throws InvalidMesh for triangles that form no surface, SolverFailure, and
/// Error where it was left out of the build.
std::vector<DiskPoint> mean_value_map(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                      const std::vector<std::int32_t>& border);

}  // namespace pectinate::detail
