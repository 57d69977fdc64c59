// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "pectinate/tracing.hpp"

namespace pectinate {

class Random;

/// Where a seed point may be drawn.
enum class SeedRegion : std::uint8_t {
  free,         ///< anywhere that is not occupied
  partly_free,  ///< the free part of partly occupied edges: within an edge length of the occupied region
  wholly_free,  ///< edges without any occupied part
};

/// What part of the surface lies within d_sep of the streamlines added so far. Grows only.
class Occupancy {
 public:
  virtual ~Occupancy() = default;

  /// May a streamline go on to this point, crossing `triangle` to reach it?
  virtual bool admits(std::int32_t triangle, const EdgePoint& point) const = 0;

  /// Marks everything within d_sep of the streamline that is joined to it on the surface within that distance (plus
  /// one edge length, so that a jagged border does not part what lies side by side).
  virtual void add(const Streamline& streamline) = 0;

  /// Withdraws the neighbourhood of a useless seed point from the drawing; streamlines may still cross it.
  virtual void retire_seed(const EdgePoint& seed) = 0;
  /// Can this point still be a seed?
  virtual bool admits_seed(const EdgePoint& seed) const = 0;
  /// A point drawn uniformly by length from a region, none if the region is empty.
  virtual std::optional<EdgePoint> draw_seed(SeedRegion region, Random& random) const = 0;

  /// Share in [0, 1] of what can be occupied that is occupied; withdrawn seed points do not count as occupied.
  virtual double coverage() const = 0;
};

/// The paper's occupancy (section 2.5): 64 bits an edge, one per sub-segment, set when any part of it comes within
/// d_sep of a streamline. Exact at the edge points, to 1/64 of an edge on the safe side; inside the triangles it is
/// an approximation: two segments may come closer than d_sep between their end points.
std::unique_ptr<Occupancy> make_edge_mask(const SurfaceMesh& mesh, const StreamlineTracer& tracer);

}  // namespace pectinate
