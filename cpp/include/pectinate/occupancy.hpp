// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "pectinate/tracing.hpp"

namespace pectinate {

class Random;

/// Where a seed may be drawn.
enum class SeedRegion : std::uint8_t {
  free,         ///< anywhere that is not occupied
  partly_free,  ///< the free part of partly occupied elements (edges or triangles): beside the occupied region
  wholly_free,  ///< elements without any occupied part
};

/// What part of the surface lies within d_sep of the streamlines added so far. Grows only.
class Occupancy {
 public:
  virtual ~Occupancy() = default;

  /// May a streamline cross `triangle` by the chord with this coordinate, which leaves at `exit`?
  virtual bool admits(std::int32_t triangle, double chord, const EdgePoint& exit) const = 0;

  /// Why it may not.
  virtual StopReason stop_reason(std::int32_t /*triangle*/, double /*chord*/) const { return StopReason::near_other; }

  /// Marks everything within d_sep of the streamline that is joined to it on the surface within that distance.
  virtual void add(const Streamline& streamline) = 0;

  /// Withdraws the neighbourhood of a useless seed from the drawing; streamlines may still cross it.
  virtual void retire_seed(const Seed& seed) = 0;
  /// Can a streamline still start here?
  virtual bool admits_seed(const Seed& seed) const = 0;
  /// A seed drawn uniformly from a region, none if the region is empty.
  virtual std::optional<Seed> draw_seed(SeedRegion region, Random& random) const = 0;

  /// Share in [0, 1] of what can be occupied that is occupied; withdrawn seeds do not count as occupied.
  virtual double coverage() const = 0;
};

/// How near streamlines may come to placed ones, in separation distances.
struct Clearance {
  double stop = 1;  ///< a streamline runs on until it is this close
  /// It starts only at chords of which some point is this far from every segment placed; at least `stop`.
  double seed = 1;
};

/// What streamlines stay out of, because the field is singular there: of the surface, what is joined to one of these
/// vertices within the radius.
struct SingularRegion {
  std::vector<std::int32_t> vertices;
  double radius = 0;  ///< unit of the mesh
};

/// Exact occupancy: for every triangle the chords that come within d_sep of a streamline, as intervals in closed form.
/// The separation of whole segments is exact anywhere on the surface, for any ratio of d_sep to edge length. Distance
/// is Euclidean, to whatever is joined on the surface through triangles that near.
std::unique_ptr<Occupancy> make_exact_occupancy(const SurfaceMesh& mesh, const StreamlineTracer& tracer,
                                                const Clearance& clearance = {}, const SingularRegion& singular = {});

/// The paper's occupancy (section 2.5): 64 bits an edge, one per sub-segment, set when any part of it comes within
/// d_sep of a streamline. Exact at the edge points, to 1/64 of an edge on the safe side; inside the triangles it is
/// an approximation: two segments may come closer than d_sep between their end points.
std::unique_ptr<Occupancy> make_edge_mask(const SurfaceMesh& mesh, const StreamlineTracer& tracer);

}  // namespace pectinate
