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

/// Where the candidates' seed points are drawn (paper section 2.7). Where a method has no admissible point, wholly
/// free edges serve, and in the end anything free.
enum class PlacementMethod : std::uint8_t {
  random,        ///< anywhere outside the occupied region
  neighborhood,  ///< on partly occupied edges: between d_sep and d_sep plus an edge length from a streamline
  distance,      ///< at `seed_distance_factor` d_sep from a placed streamline
};

/// Why the placement ended.
enum class PlacementEnd : std::uint8_t {
  complete,   ///< nothing is free
  cancelled,  ///< the progress callback said stop; what is there is valid, coverage is not complete
};

struct PlacementOptions {
  double separation_distance = 1.6;  ///< d_sep, unit of the mesh, > 0
  PlacementMethod method = PlacementMethod::distance;
  int seed_count = 32;                ///< n_seeds, candidates a step, >= 1; the longest is kept
  double seed_distance_factor = 1.3;  ///< c_seed, >= 1, of method `distance`
  double abrupt_turn_angle = TracingOptions{}.abrupt_turn_angle;  ///< radians, in (0, pi]; pi disables criterion 4
  std::int64_t max_steps = TracingOptions{}.max_steps;            ///< triangles crossed each way, >= 1
  std::uint64_t random_seed = 20190101;                           ///< the same seed gives the same bytes
  int thread_count = 1;                                           ///< >= 1; the result does not depend on it
  /// Called now and then with the coverage in [0, 1], from the calling thread; false ends the placement.
  std::function<bool(double coverage)> progress;
};

/// Evenly spaced streamlines, one after the other in the order of placement. Streamline i owns the points
/// [offsets[i], offsets[i + 1]) and the segments [offsets[i] - i, offsets[i + 1] - i - 1).
struct Placement {
  std::vector<Vec3> points;
  std::vector<std::int64_t> offsets;            ///< streamline count + 1
  std::vector<std::int32_t> segment_triangles;  ///< per segment: the mesh triangle that it crosses
  std::vector<std::int32_t> point_triangles;    ///< per point: a mesh triangle that it lies on
  std::vector<Vec3> barycentric;                ///< per point: weights of that triangle's corners, sum 1
  std::vector<double> lengths;
  std::vector<std::array<StopReason, 2>> stop_reasons;  ///< at the first and the last point
  std::vector<std::int64_t> seed_points;                ///< per streamline: the index in `points` of its seed
  PlacementStatistics statistics;
  PlacementOptions options;  ///< as used, `progress` left out
  PlacementEnd end = PlacementEnd::complete;
};

/// Fills the surface with streamlines no closer than d_sep, one by one, each the longest of `seed_count` candidates,
/// until nothing is free (paper sections 2.4 to 2.7). Ends always: each step takes a free sub-segment of an edge.
///
/// The same arguments give the same bytes, whatever `thread_count`. Throws InvalidOption, InvalidField.
Placement place_streamlines(const SurfaceMesh& mesh, const OrientationField& field, const PlacementOptions& options);

}  // namespace pectinate
