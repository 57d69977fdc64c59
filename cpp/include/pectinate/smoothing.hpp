// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pectinate/orientation_field.hpp"

namespace pectinate {

struct SmoothingOptions {
  /// The size of what is smoothed away, in the unit of the mesh, from a millionth of the diagonal of its bounding box
  /// to ten of them: fibres are compared with those around them under a weight that falls off like a Gaussian of this
  /// standard deviation.
  double length = 1.5;
  /// A fibre that differs by more than this from those around it is replaced; radians in (0, pi/2].
  double outlier_angle = 0.2967059728390360;  // 17 degrees
  /// Give a direction to triangles that have none too.
  bool fill_missing = false;
};

struct Smoothing {
  OrientationField field;
  /// Per mesh triangle, radians in [0, pi/2]: how far the fibre was moved; NaN where it had or has none.
  std::vector<double> moved_angles;
  /// Per mesh triangle, 1 where the fibre was an outlier and was replaced by what the others around it say.
  std::vector<std::uint8_t> outliers;
};

/// Robust smoothing of a measured field, on z = exp(2 i theta) with parallel transport between triangles.
///
/// First the consensus: z that minimises the sum over triangles of area times Geman and McClure's loss of z - measured,
/// plus length^2 / 2 times the Dirichlet energy (a screened Laplacian: variance length^2 an axis). Far-off fibres have
/// next to no say in it, so edges between coherent regions survive. Then fibres farther than `outlier_angle` from the
/// consensus are dropped, and the others alone are smoothed over 0.18 of the length, which fills the gaps.
/// So a field that is smooth already hardly changes, and most fibres of a noisy one move little.
///
/// `barriers` is empty, or holds one label per mesh triangle: nothing is exchanged between triangles of different
/// label. Signs mean nothing, in or out. Resets the C library's rand() as `FieldInterpolator` does. Throws
/// InvalidOption for an option out of its range and a wrong count of labels, InvalidField for the field of another
/// mesh.
Smoothing smooth(const SurfaceMesh& mesh, const OrientationField& field, const SmoothingOptions& options = {},
                 std::span<const std::int32_t> barriers = {});

}  // namespace pectinate
