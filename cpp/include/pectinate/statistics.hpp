// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pectinate/tracing.hpp"

namespace pectinate {

/// Figures of a placement (paper section 2.7); lengths in the unit of the mesh, all 0 where there is no streamline.
struct PlacementStatistics {
  std::int64_t streamline_count = 0;  ///< n
  double total_length = 0;
  double mean_length = 0;           ///< L_avg
  double length_weighted_mean = 0;  ///< sum L^2 / sum L: the length of the line that a random point of a line is on
  double surface_area = 0;          ///< A, of the triangles with a direction
  double mean_spacing = 0;          ///< d_avg = A / (n L_avg)
  double mean_spacing_ratio = 0;    ///< d_avg / d_sep
  double short_fraction = 0;        ///< share of streamlines shorter than d_sep
  double coverage = 0;              ///< share of the edges' length that is within d_sep of a streamline
  std::array<std::int64_t, stop_reason_count> stop_counts{};  ///< ends by StopReason, two per streamline
  std::int64_t polishing_rounds = 0;                          ///< played
};

/// Counts of lengths in equal bins from 0 to the longest; `edges` has one more element than `counts`.
struct LengthHistogram {
  std::vector<double> edges;
  std::vector<std::int64_t> counts;
};

PlacementStatistics placement_statistics(std::span<const double> lengths,
                                         std::span<const std::array<StopReason, 2>> stop_reasons, double surface_area,
                                         double separation_distance, double coverage);

/// `bin_count` >= 1, else InvalidOption. Every length is counted once; the last bin includes its upper edge.
LengthHistogram length_histogram(std::span<const double> lengths, int bin_count);

}  // namespace pectinate
