// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "detail/connection.hpp"
#include "detail/tract_projection.hpp"
#include "pectinate/constraints.hpp"

namespace pectinate::detail {

/// What a tract or a boundary condition (-1) asks of a triangle.
struct Demand {
  std::int32_t triangle;
  Phase phase;  ///< unit, in the triangle's frame
  double weight;
  std::int32_t tract;
};

/// Of several demands on each triangle makes one; those of one triangle are listed as they prevail. Demands that differ
/// by more than `conflict_angle` from one that is kept are dropped and reported; kept ones are averaged by weight, hard
/// ones over weighted ones. Results and conflicts are ascending by triangle.
struct SettledDemands {
  std::vector<Demand> demands;
  std::vector<ConstraintConflict> conflicts;
};
SettledDemands settle(std::vector<Demand> demands, double conflict_angle);

/// What a tract asks of the triangles that it crosses, and where it contradicts itself.
SettledDemands tract_demands(const SurfaceMesh& mesh, const TractCurve& curve, const Tract& tract, std::int32_t index,
                             double conflict_angle);

}  // namespace pectinate::detail
