// SPDX-License-Identifier: MIT
#include "pectinate/statistics.hpp"

#include <algorithm>
#include <string>

#include "pectinate/errors.hpp"

namespace pectinate {

PlacementStatistics placement_statistics(std::span<const double> lengths,
                                         std::span<const std::array<StopReason, 2>> stop_reasons, double surface_area,
                                         double separation_distance, double coverage) {
  PlacementStatistics result;
  result.streamline_count = static_cast<std::int64_t>(lengths.size());
  result.surface_area = surface_area;
  result.coverage = coverage;
  double squares = 0;
  std::int64_t short_count = 0;
  for (const double length : lengths) {
    result.total_length += length;
    squares += length * length;
    short_count += length < separation_distance;
  }
  for (const auto& ends : stop_reasons) {
    for (const auto reason : ends) result.stop_counts[static_cast<std::size_t>(reason)] += 1;
  }
  if (lengths.empty()) return result;
  const auto count = static_cast<double>(lengths.size());
  result.mean_length = result.total_length / count;
  result.length_weighted_mean = squares / result.total_length;
  result.mean_spacing = surface_area / result.total_length;
  result.mean_spacing_ratio = result.mean_spacing / separation_distance;
  result.short_fraction = static_cast<double>(short_count) / count;
  return result;
}

LengthHistogram length_histogram(std::span<const double> lengths, int bin_count) {
  if (bin_count < 1) {
    throw InvalidOption("bin_count is " + std::to_string(bin_count) + ", but must be at least 1");
  }
  const double longest = lengths.empty() ? 0 : *std::max_element(lengths.begin(), lengths.end());
  LengthHistogram histogram;
  histogram.counts.assign(bin_count, 0);
  for (int i = 0; i < bin_count; ++i) histogram.edges.push_back(longest * i / bin_count);
  histogram.edges.push_back(longest);
  for (const double length : lengths) {
    const auto above = std::upper_bound(histogram.edges.begin(), histogram.edges.end(), length);
    const auto bin = std::min<std::int64_t>(above - histogram.edges.begin(), bin_count) - 1;
    histogram.counts[bin] += 1;
  }
  return histogram;
}

}  // namespace pectinate
