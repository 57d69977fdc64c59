// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "detail/triangle_tree.hpp"
#include "pectinate/constraints.hpp"

namespace pectinate::detail {

/// A projected tract and, per segment, its direction: any length, and more exact than the difference of its points.
struct TractCurve {
  ProjectedTract projected;
  std::vector<Vector> directions;
  bool closed;  ///< the last point is the first
};

/// How messages call a tract: tract 2 "Bachmann".
std::string tract_label(std::size_t index, const Tract& tract);

/// Points of the tract nearer to each other than 1e-9 of a triangle's side count as one. Throws InvalidOption as
/// make_constraints does.
TractCurve project_tract(const SurfaceMesh& mesh, const TriangleTree& tree, const Tract& tract,
                         const std::string& label, double maximum_distance);

}  // namespace pectinate::detail
