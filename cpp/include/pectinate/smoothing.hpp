// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pectinate/orientation_field.hpp"

namespace pectinate {

struct SmoothingOptions {
  /// The length over which fibres are brought to agree, in the unit of the mesh, positive.
  double length = 1.5;
  /// A fibre farther than this from its smoothed neighbourhood, radians in (0, pi/2], loses influence as 1 / distance
  /// (Huber's loss on exp(2 i theta)).
  double outlier_angle = 0.1745329251994330;  // 10 degrees
  /// Re-weighted solves, 1 to 1000.
  std::int32_t max_iterations = 30;
  /// Give a direction to triangles that have none too.
  bool fill_missing = false;
};

struct Smoothing {
  OrientationField field;
  /// Per mesh triangle, radians in [0, pi/2]: how far the fibre was moved; NaN where it had or has none.
  std::vector<double> moved_angles;
  std::int32_t iterations;
  bool converged;
};

/// Robust smoothing of a measured field: minimises the sum over triangles of area times Huber's loss of z - z_measured,
/// plus length^2 times the Dirichlet energy of z, z = exp(2 i theta) with parallel transport between triangles.
///
/// `barriers` is empty, or holds one label per mesh triangle: nothing is exchanged between triangles of different
/// label. Signs mean nothing, in or out. Throws InvalidOption for an option out of its range, InvalidField for a wrong
/// count.
Smoothing smooth(const SurfaceMesh& mesh, const OrientationField& field, const SmoothingOptions& options = {},
                 std::span<const std::int32_t> barriers = {});

}  // namespace pectinate
