// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "detail/fans.hpp"
#include "detail/scratch.hpp"
#include "pectinate/surface_mesh.hpp"

namespace pectinate::detail {

/// Joined triangles, and how to wind them.
struct Orientation {
  std::vector<std::int32_t> triangle_components;
  std::vector<bool> orientable;          ///< per component
  std::vector<std::int32_t> to_reverse;  ///< triangles, in ascending order
};

/// Finds the components and the reversals that make neighbours agree, against as few input windings as possible.
/// Where a component is not orientable, neighbours disagree along a seam. Uses an empty vector's room for components.
Orientation find_orientation(const Neighbours& neighbours, std::vector<std::int32_t> room, Scratch& scratch);

/// For each component of a mesh wound like that: do its normals point inwards? Told by the volume under it, with its
/// openings closed by fans; never for non-orientable or (nearly) flat ones.
std::vector<bool> points_inwards(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                 const std::vector<std::int32_t>& triangle_components,
                                 const std::vector<SurfaceComponent>& components,
                                 const std::vector<BoundaryLoop>& loops);

}  // namespace pectinate::detail
