// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "pectinate/orientation_field.hpp"
#include "pectinate/parameterization.hpp"

namespace pectinate {

/// The angle between the two lines of each mesh triangle, radians in [0, pi/2]; NaN where either has none.
std::vector<double> angles_between(const OrientationField& first, const OrientationField& second);

/// Turns every direction in its triangle's plane by a normal random angle (paper section 3.4, Fig. 10), independently,
/// of mean 0 and the given standard deviation, radians, not negative. The same seed gives the same noise.
OrientationField add_angular_noise(const SurfaceMesh& mesh, const OrientationField& field, double standard_deviation,
                                   std::uint64_t random_seed = 1);

/// A field carried to another surface, with what each target triangle was given from.
struct Transfer {
  OrientationField field;                      ///< on the target
  std::vector<std::int32_t> source_triangles;  ///< per target triangle; -1 where there is no counterpart
  std::vector<double> distances;               ///< from the target triangle's centre to its counterpart
};

/// To every target triangle the field at the point of the source nearest to its centre, turned by the smallest rotation
/// between the two normals. Triangles farther than `maximum_distance` get none (positive; infinity: all get one).
Transfer transfer_by_nearest_point(const SurfaceMesh& source, const OrientationField& field, const SurfaceMesh& target,
                                   double maximum_distance);

/// To every target triangle the field at the point of the source with the same place in the disk, carried by the
/// differential of the maps. The disks are first brought together by the rotation under which the loops of `loop_pairs`
/// (source loop, target loop) fit best by the centres of their holes. Throws InvalidOption for a loop that does not
/// exist or is given twice, and for fewer than one pair of inner loops.
Transfer transfer_through_disks(const SurfaceMesh& source, const Parameterization& source_disk,
                                const OrientationField& field, const SurfaceMesh& target,
                                const Parameterization& target_disk,
                                const std::vector<std::array<std::int32_t, 2>>& loop_pairs);

/// Per mesh vertex the principal direction of the area-weighted sum of v v^T over the triangles around it: the field
/// per vertex, for solvers that want it so. Unit; zero where no triangle around has a direction.
std::vector<Vec3> vertex_directions(const SurfaceMesh& mesh, const OrientationField& field);

}  // namespace pectinate
