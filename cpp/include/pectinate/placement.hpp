// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "pectinate/orientation_field.hpp"
#include "pectinate/statistics.hpp"
#include "pectinate/surface_mesh.hpp"
#include "pectinate/tracing.hpp"

namespace pectinate {

/// In which order streamlines are placed. The paper's methods (section 2.7) keep the longest of `seed_count` candidates
/// whose seeds are drawn at random; where a method has no admissible seed, wholly free elements serve, and in the end
/// anything free.
enum class PlacementMethod : std::uint8_t {
  random,        ///< seeds anywhere outside the occupied region
  neighborhood,  ///< seeds beside the occupied region: between d_sep and d_sep plus an edge length from a streamline
  distance,      ///< seeds at `seed_distance_factor` d_sep from a placed streamline
  longest,  ///< always the longest that still fits, of a dense pool of candidates; exact occupancy, no random seeds
};

/// How it is known what is within d_sep of a streamline.
enum class OccupancyModel : std::uint8_t {
  exact,      ///< whole segments, anywhere on the surface
  edge_mask,  ///< the paper's 64 bits an edge (section 2.5): exact at edge points only
};

/// Why the placement ended.
enum class PlacementEnd : std::uint8_t {
  complete,   ///< no segment fits any more
  cancelled,  ///< the progress callback said stop; what is there is valid, coverage is not complete
};

struct PlacementOptions {
  double separation_distance = 1.6;  ///< d_sep, unit of the mesh, > 0
  /// d_sep per mesh triangle, of the placed streamline there; replaces `separation_distance` where it is not empty.
  std::vector<double> separation_distances{};
  PlacementMethod method = PlacementMethod::longest;
  OccupancyModel occupancy = OccupancyModel::exact;
  int seed_count = 32;                ///< n_seeds of the paper's methods, candidates a step, in [1, 10^6]
  double seed_distance_factor = 1.3;  ///< c_seed, >= 1, of method `distance`
  /// Streamlines are placed only through triangles where they are somewhere this many d_sep from all others, in [1, 2]:
  /// above 1 (1.155 is good) fewer and longer ones, still d_sep apart, leave small gaps. Those of method `longest` that
  /// are at least 9 d_sep long need it not, unless `test_distance` is below 1. Exact occupancy only.
  double seed_clearance = 1;
  /// Streamlines run on until they are this many d_sep from others, in (0, 1]: below 1 they grow longer, but only this
  /// far apart (d_test of Jobard and Lefer 1997). Exact occupancy only.
  double test_distance = 1;
  double minimum_length = 0;  ///< shorter streamlines are not placed, unit of the mesh, >= 0
  /// Closed curves of the field become closed streamlines, placed before others that wind onto them, if they are at
  /// least 4 d_sep long. Method `longest` only; off, they end near themselves.
  bool close_loops = false;
  /// Streamlines stop this near to singularities (vertices about which the field turns, as `field_topology` finds
  /// them), unit of the mesh, >= 0; 0 lets them come as near as they do. What is that near counts as covered. Exact
  /// occupancy only.
  double singularity_radius = 0;
  /// Rounds of polishing after the placement: each takes out a few streamlines that lie together and fills their place
  /// with others, so that in the end the mean length is greater, total length and coverage no less (as they are before
  /// ends run on into the midst of triangles), and all else as promised. 0 is none, but if `polishing_time` is not 0,
  /// as many as there is time for. Method `longest` only.
  std::int64_t polishing_rounds = 0;
  /// Seconds of wall time after which polishing ends, >= 0; 0 is no limit. `PlacementStatistics` has the number of
  /// rounds, and so many without a limit give the same bytes.
  double polishing_time = 0;
  double abrupt_turn_angle = TracingOptions{}.abrupt_turn_angle;  ///< radians, in (0, pi]; pi disables criterion 4
  std::int64_t max_steps = TracingOptions{}.max_steps;            ///< triangles crossed each way, >= 1
  std::uint64_t random_seed = 20190101;                           ///< the same seed gives the same bytes
  /// >= 1; the result does not depend on it. Methods with random seeds use more than one, at steps with enough to
  /// trace.
  int thread_count = 1;
  /// Called now and then with the coverage in [0, 1], from the calling thread; false ends the placement.
  std::function<bool(double coverage)> progress;
};

/// Evenly spaced streamlines, one after the other in the order of placement. Streamline i owns the points
/// [offsets[i], offsets[i + 1]) and the segments [offsets[i] - i, offsets[i + 1] - i - 1). Points lie on edges, but for
/// ends of method `longest` that stop near others or themselves: those are where the others, or a part of their own,
/// are d_sep away, in the midst of triangles (on edges where that is less than 1e-3 d_sep farther on, where the rest of
/// the triangle is longer than 64 d_sep, and of those near themselves where they come back to the same triangle, or
/// where the part that they stopped for is none of the streamline any more).
struct Placement {
  std::vector<Vec3> points;
  std::vector<std::int64_t> offsets;            ///< streamline count + 1
  std::vector<std::int32_t> segment_triangles;  ///< per segment: the mesh triangle that it crosses
  std::vector<std::int32_t> point_triangles;    ///< per point: a mesh triangle that it lies on
  std::vector<Vec3> barycentric;                ///< per point: weights of that triangle's corners, sum 1
  std::vector<double> lengths;
  std::vector<std::array<StopReason, 2>> stop_reasons;  ///< at the first and the last point
  std::vector<std::int64_t> seed_points;                ///< per streamline: index in `points` of its seed, or middle
  PlacementStatistics statistics;
  PlacementOptions options;  ///< as used, `progress` left out
  PlacementEnd end = PlacementEnd::complete;
};

/// Fills the surface with streamlines no closer than d_sep, one by one, until nothing is free (paper sections 2.4 to
/// 2.7). With exact occupancy and `test_distance` 1, whole streamlines are at least d_sep apart, and parts of one that
/// are more than 2 d_sep apart along it too (points only for the paper's methods; along a closed one, the shorter way
/// round). Ends always.
///
/// The same arguments give the same bytes, whatever `thread_count`, unless `polishing_time` limits the rounds. Throws
/// InvalidOption, InvalidField.
Placement place_streamlines(const SurfaceMesh& mesh, const OrientationField& field, const PlacementOptions& options);

}  // namespace pectinate
