// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "pectinate/surface_mesh.hpp"

namespace pectinate {

/// A point of the unit disk.
using DiskPoint = std::array<double, 2>;

struct ParameterizationOptions {
  /// Index into `mesh.boundary_loops()` of the loop that becomes the circle; the longest of the component when absent.
  std::optional<std::int32_t> outer_loop = std::nullopt;
};

/// How a triangle is stretched on its way to the disk.
struct TriangleDistortion {
  double area_ratio;  ///< area in the disk over area on the surface, both as shares of their totals; signed
  double anisotropy;  ///< greater over smaller singular value of the map, >= 1; infinite for a flat triangle
};

/// The mean value map of a surface onto the unit disk (paper section 2.2; Floater, Comput. Aided Geom. Des. 2003).
/// What belongs to fragments, components beside the one that is mapped, has no place in the disk: NaN.
struct Parameterization {
  std::vector<DiskPoint> points;  ///< per mesh vertex; those of the outer loop lie on the unit circle
  std::int32_t outer_loop;        ///< index into `mesh.boundary_loops()`, whose component is the one mapped
  /// Second longest over longest loop: above 0.8 the choice of the longest says little. 0 with a single loop.
  double loop_ambiguity;
  /// Per boundary loop, the image of the vertex that closes it as a hole; of the outer loop, the origin.
  std::vector<DiskPoint> loop_centres;
  std::vector<std::int32_t> flipped_triangles;  ///< mesh triangles of zero or negative area in the disk
  std::vector<TriangleDistortion> distortion;   ///< per mesh triangle
};

/// Whether the library was built with CGAL, without which there is no parameterization.
bool has_parameterization();

/// Maps a surface onto the unit disk: all holes but the outer loop are closed by a fan to a new vertex, the outer loop
/// goes to the circle in proportion to its edge lengths, its first vertex to (1, 0), and every other vertex to the
/// average of its neighbours under mean value weights. Seen from outside the surface, the disk is seen from +z.
/// Throws InvalidMesh for a surface that is not one orientable component of genus 0 with a boundary (fragments of at
/// most 1 % of the area beside it are passed over), InvalidOption for a loop that does not exist or bounds a fragment,
/// SolverFailure if the linear system has no solution, Error in a build without CGAL.
Parameterization parameterize(const SurfaceMesh& mesh, const ParameterizationOptions& options = {});

}  // namespace pectinate
