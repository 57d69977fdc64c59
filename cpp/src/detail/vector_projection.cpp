// SPDX-License-Identifier: MIT
#include "detail/vector_projection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "detail/large_array.hpp"
#include "detail/vec.hpp"

namespace pectinate::detail {
#define PECTINATE_KERNEL "detail/projection_lanes.inl"
#include "detail/kernel_variants.inl"

PlanarDirections project_vectors(const SurfaceMesh& mesh, std::span<const Vec3> vectors) {
  PlanarDirections all;
  const auto count = mesh.triangle_count();
  back_together({make_room(all.units, count), make_room(all.status, count), make_room(all.out_of_plane_angles, count)});
  PECTINATE_CALL_KERNEL(project_all, mesh, vectors, all);
  return all;
}

}  // namespace pectinate::detail
