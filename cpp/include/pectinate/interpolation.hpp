// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "pectinate/constraints.hpp"
#include "pectinate/orientation_field.hpp"
#include "pectinate/reference_frame.hpp"

namespace pectinate {

/// A vertex around which an orientation field turns against the surface.
struct Singularity {
  std::int32_t vertex;      ///< of the mesh, interior
  std::int32_t half_turns;  ///< twice the index: 1 for +1/2 (a loop around), -1 for -1/2 (a triradius), 2 for +1, ...
  Vec3 position;
};

/// The field's singular points, and its turns along each boundary loop against the loop's own tangent. The half turns
/// of all add up to twice the Euler characteristic of every orientable component whose triangles all have a direction.
struct FieldTopology {
  std::vector<Singularity> singularities;  ///< ascending by vertex; none at vertices with a triangle without direction
  std::vector<std::int32_t> loop_half_turns;  ///< per boundary loop; 0 for fibres parallel or perpendicular to it
};

/// Counts singularities by the angles between neighbouring triangles, each taken as the least turn in the surface.
FieldTopology field_topology(const SurfaceMesh& mesh, const OrientationField& field);

/// The Dirichlet energy of a field: half the sum over inner edges of weight times |z - transported neighbour|^2,
/// z = exp(2 i theta); the weight of an edge is its length over the distance of the circumcentres. No unit.
double dirichlet_energy(const SurfaceMesh& mesh, const OrientationField& field);

/// A field made of constraints.
struct Interpolation {
  OrientationField field;
  /// Per mesh triangle, in [0, 1]: the magnitude of the interpolated phase phi. Near 0 around singularities and where
  /// constraints disagree.
  std::vector<double> confidence;
};

/// Interpolates orientations over a surface: minimises the Dirichlet energy of the phase phi = exp(2 i theta) under
/// constraints (paper section 2.3). Keeps its factorization, so that edits of some constraints cost far less than a new
/// solver.
///
/// By `connection` the phase is carried from triangle to triangle by unfolding them (the Levi-Civita connection): any
/// surface, closed, with handles, not orientable, of several components. By `reference frame` the angle is taken in a
/// frame given for the whole surface, as in the paper. On a component without hard or weighted constraints the result
/// is the smoothest field of unit mean square (Knoeppel et al., ACM Trans. Graph. 2013).
class FieldInterpolator {
 public:
  /// Throws SolverFailure if the factorization fails.
  explicit FieldInterpolator(const SurfaceMesh& mesh);
  FieldInterpolator(const SurfaceMesh& mesh, const ReferenceFrame& frame);
  FieldInterpolator(FieldInterpolator&&) noexcept;
  FieldInterpolator& operator=(FieldInterpolator&&) noexcept;
  ~FieldInterpolator();

  /// Replaces all constraints; what stays costs nothing. Hard constraints are met exactly.
  /// Throws InvalidField for a triangle that does not exist, is given twice, or a direction that is zero or normal.
  void set_constraints(const std::vector<TriangleConstraint>& constraints);
  Interpolation solve() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A field from constraints, once.
Interpolation interpolate(const SurfaceMesh& mesh, const std::vector<TriangleConstraint>& constraints);
Interpolation interpolate(const SurfaceMesh& mesh, const ReferenceFrame& frame,
                          const std::vector<TriangleConstraint>& constraints);

}  // namespace pectinate
