// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pectinate/constraints.hpp"
#include "pectinate/orientation_field.hpp"
#include "pectinate/reference_frame.hpp"

namespace pectinate {

/// A field made of constraints.
struct Interpolation {
  OrientationField field;
  /// Per mesh triangle, in [0, 1]: the magnitude of the interpolated phase phi. Near 0 around singularities and where
  /// constraints disagree; on curved surfaces small too where only weak weights act: far below 1 they do not hold phi
  /// at magnitude 1 against what the curvature takes from it, though its angle is as good.
  std::vector<double> confidence;
};

/// Interpolates orientations over a surface: minimises the Dirichlet energy of the phase phi = exp(2 i theta) under
/// constraints (paper section 2.3). Keeps its factorization, so that an edit of some constraints costs far less than a
/// new interpolator, and gives the same bytes. Its construction resets the C library's rand(), as METIS does that
/// orders the elimination; what it draws from there does not depend on earlier seeds, but would on threads that call
/// rand() meanwhile.
///
/// By *connection* the phase is carried from triangle to triangle by unfolding them (the Levi-Civita connection): any
/// surface, closed, with handles, not orientable, of several components. By *reference frame* the angle is taken in a
/// frame given for the whole surface, as in the paper. A component without constraints gets its smoothest field
/// (Knoeppel et al., ACM Trans. Graph. 2013), scaled to a greatest magnitude of 1.
class FieldInterpolator {
 public:
  /// The mesh must outlive the interpolator. Throws InvalidField for a frame of another mesh.
  explicit FieldInterpolator(const SurfaceMesh& mesh);
  FieldInterpolator(const SurfaceMesh& mesh, const ReferenceFrame& frame);
  FieldInterpolator(FieldInterpolator&&) noexcept;
  FieldInterpolator& operator=(FieldInterpolator&&) noexcept;
  ~FieldInterpolator();

  /// The field under these constraints; the same as in the last call cost nothing. Hard constraints are
  /// met exactly. Throws InvalidField for a triangle that does not exist or is given twice, a direction that is zero,
  /// not finite or normal to its triangle, and a weight that is neither `hard` nor in [`least_weight`,
  /// `greatest_weight`].
  Interpolation interpolate(std::span<const TriangleConstraint> constraints);

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// A field from constraints, once.
Interpolation interpolate(const SurfaceMesh& mesh, std::span<const TriangleConstraint> constraints);
Interpolation interpolate(const SurfaceMesh& mesh, const ReferenceFrame& frame,
                          std::span<const TriangleConstraint> constraints);

}  // namespace pectinate
