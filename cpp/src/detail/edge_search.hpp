// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "detail/capsule.hpp"
#include "pectinate/surface_mesh.hpp"
#include "pectinate/tracing.hpp"

namespace pectinate::detail {

/// Finds the edges near a streamline by breadth-first search over the surface, so that another branch of the surface
/// that is near in space only is left out (paper section 2.5). Nothing is precomputed: the cost is that of the area
/// within reach. Crosses cuts at non-manifold edges, where surfaces do touch.
class EdgeSearch {
 public:
  explicit EdgeSearch(const SurfaceMesh& mesh);

  struct Found {
    std::int32_t edge;
    Interval interval;  ///< of the edge's parameter, within [0, 1]
  };

  /// The edges that enter the capsule of given radius around segment `segment` of the streamline and are joined to it
  /// by edges no farther than about `radius` plus their own length. Valid until the next call.
  const std::vector<Found>& near_segment(const Streamline& streamline, std::size_t segment, double radius);

 private:
  void reach(std::int32_t triangle);
  void examine(std::int32_t edge, const Capsule& capsule);

  const SurfaceMesh& mesh_;
  std::uint32_t round_ = 0;
  std::vector<std::uint32_t> triangle_round_, edge_round_;  // in which round it was reached last
  std::vector<std::int32_t> queue_;
  std::vector<Found> found_;
};

}  // namespace pectinate::detail
