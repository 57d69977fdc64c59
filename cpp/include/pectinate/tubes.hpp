// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pectinate/placement.hpp"
#include "pectinate/surface_mesh.hpp"
#include "pectinate/types.hpp"

namespace pectinate {

struct TubeOptions {
  double radius = 0.18;       ///< rho_0, unit of the mesh, > 0
  double taper_length = 2.0;  ///< lambda, unit of the mesh, >= 0; 0 gives blunt ends
  int side_count = 8;         ///< in [3, 12]
  double height = 1.0;        ///< of the tubes over their width, in (0, 1]; below 1 they lie flat on the surface
};

/// Closed triangle meshes, one per streamline, one after the other; counter-clockwise seen from outside.
struct Tubes {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::int64_t> vertex_offsets;    ///< streamline count + 1
  std::vector<std::int64_t> triangle_offsets;  ///< streamline count + 1
  /// Where along the streamlines each vertex is: the index of a point of the placement, and the share of the way to the
  /// next one.
  std::vector<double> vertex_points;
};

/// Regular polygons extruded along the streamlines with the radius of the paper's equation (3),
/// rho(s) = rho_0 (1 - exp(-s / lambda)) (1 - exp(-(L - s) / lambda)), aligned by the surface normals (section 2.8).
/// Each tube is watertight; that of a closed streamline is a ring of radius rho_0. Throws InvalidOption.
Tubes make_tubes(const SurfaceMesh& mesh, const Placement& placement, const TubeOptions& options = {});

}  // namespace pectinate
