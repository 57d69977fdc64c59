// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "detail/edge_search.hpp"
#include "pectinate/occupancy.hpp"

namespace pectinate::detail {

/// The seed points of method `distance`: where edges leave the region within a multiple of d_sep of each placed
/// streamline (paper section 2.7). Points that become occupied are dropped when they are met.
class SeedRing {
 public:
  SeedRing(const SurfaceMesh& mesh, const StreamlineTracer& tracer, double factor);

  void add(const Streamline& streamline);

  /// A point drawn evenly from those that can still be seeds, none if there are none.
  std::optional<Seed> draw(const Occupancy& occupancy, Random& random);

 private:
  EdgeSearch search_;
  const StreamlineTracer& tracer_;
  double factor_;
  std::vector<EdgeSearch::Found> partial_;   // of the streamline at hand: edges that are partly within reach
  std::vector<std::uint32_t> inside_round_;  // per edge: the last round in which it was wholly within reach
  std::uint32_t round_ = 0;                  // one a streamline
  std::vector<Seed> seeds_;
};

}  // namespace pectinate::detail
