// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pectinate/orientation_field.hpp"
#include "pectinate/parameterization.hpp"

namespace pectinate {

/// The angle between the two lines of each mesh triangle, radians in [0, pi/2]; NaN where either has none.
/// Throws InvalidField for fields on different numbers of triangles.
std::vector<double> angles_between(const OrientationField& first, const OrientationField& second);

/// Turns every direction in its triangle's plane by a normal random angle (paper section 3.4, Fig. 10), independently,
/// of mean 0 and the given standard deviation, radians in [0, pi]. The same seed gives the same noise, triangle by
/// triangle, whatever the field. Throws InvalidField for a wrong count, InvalidOption for another standard deviation.
OrientationField add_angular_noise(const SurfaceMesh& mesh, const OrientationField& field, double standard_deviation,
                                   std::uint64_t random_seed = 1);

/// A field carried to another surface, with what each target triangle was given from. A triangle whose counterpart has
/// no direction gets none.
struct Transfer {
  OrientationField field;                      ///< on the target
  std::vector<std::int32_t> source_triangles;  ///< per target triangle; -1 where there is no counterpart
  /// In space, from the target triangle's centre to its counterpart; NaN where there is none.
  std::vector<double> distances;
};

/// To every target triangle the field at the point of the source nearest to its centre, turned by the smallest rotation
/// between the two planes. Triangles farther than `maximum_distance` get none (positive; infinity: all get one).
/// Throws InvalidField for a wrong count or when no target triangle gets a direction; InvalidOption for a
/// `maximum_distance` that is not positive, or a target out of the reach of `nearest_surface_points`.
Transfer transfer_by_nearest_point(const SurfaceMesh& source, const OrientationField& field, const SurfaceMesh& target,
                                   double maximum_distance);

/// To every target triangle the field at the point of the source with the same place in the disk, carried by the
/// differential of the maps; none where that place is in a hole of the source. The disks are first brought together by
/// the rotation under which the loops of `loop_pairs` (source loop, target loop) fit best by the centres of their
/// holes. Triangles that are flat or flipped in their disk take no part. Throws InvalidOption for a parameterization of
/// another mesh; for a loop that does not exist, bounds a fragment, is given twice or is an outer one paired with an
/// inner one; for fewer than one pair of inner loops, or pairs that fix no rotation. Throws InvalidField for a wrong
/// count or when no target triangle gets a direction.
Transfer transfer_through_disks(const SurfaceMesh& source, const Parameterization& source_disk,
                                const OrientationField& field, const SurfaceMesh& target,
                                const Parameterization& target_disk,
                                const std::vector<std::array<std::int32_t, 2>>& loop_pairs);

/// Per mesh vertex the principal direction of the area-weighted sum of v v^T over the triangles around it: the field
/// per vertex, for solvers that want it so. Unit; zero where no triangle around has a direction, or they prefer none.
/// Throws InvalidField for a wrong count.
std::vector<Vec3> vertex_directions(const SurfaceMesh& mesh, const OrientationField& field);

}  // namespace pectinate
