// SPDX-License-Identifier: MIT
#include "detail/vector_projection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "detail/large_array.hpp"
#include "detail/vec.hpp"

namespace pectinate::detail {
namespace {

/// Most made fields lie in the plane: there the angle is its tangent, to the last bit.
double angle_of_tangent(double tangent) {
  return tangent < 1e-9 ? tangent : std::atan(tangent);
}

}  // namespace

#define PECTINATE_KERNEL "detail/projection_lanes.inl"
#include "detail/kernel_variants.inl"

PlanarDirections project_vectors(const SurfaceMesh& mesh, std::span<const Vec3> vectors) {
  return PECTINATE_CALL_KERNEL(project_all, mesh, vectors);
}

}  // namespace pectinate::detail
