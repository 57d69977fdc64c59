// SPDX-License-Identifier: MIT
#include "detail/seed_ring.hpp"

#include <algorithm>
#include <vector>

#include "detail/edge_point.hpp"
#include "detail/random.hpp"

namespace pectinate::detail {

SeedRing::SeedRing(const SurfaceMesh& mesh, double distance)
    : search_(mesh), distance_(distance), inside_round_(mesh.edges().size(), 0) {}

void SeedRing::add(const Streamline& streamline) {
  ++round_;
  partial_.clear();
  for (std::size_t segment = 0; segment < streamline.triangles.size(); ++segment) {
    for (const auto& found : search_.near_segment(streamline, segment, distance_)) {
      if (found.interval.low == 0 && found.interval.high == 1) {
        inside_round_[found.edge] = round_;
      } else if (inside_round_[found.edge] != round_) {
        partial_.push_back(found);
      }
    }
  }
  std::erase_if(partial_, [&](const auto& found) { return inside_round_[found.edge] == round_; });
  std::sort(partial_.begin(), partial_.end(), [](const auto& a, const auto& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.interval.low < b.interval.low;
  });
  const auto add_point = [&](std::int32_t edge, double position) {
    if (position > least_position && position < 1 - least_position) points_.push_back({edge, position});
  };
  for (std::size_t first = 0, next = 0; first < partial_.size(); first = next) {
    const auto& [edge, start] = partial_[first];
    double end = start.high;
    for (next = first + 1; next < partial_.size(); ++next) {
      if (partial_[next].edge != edge || partial_[next].interval.low > end) break;
      end = std::max(end, partial_[next].interval.high);
    }
    add_point(edge, start.low);
    add_point(edge, end);
  }
}

std::optional<EdgePoint> SeedRing::draw(const Occupancy& occupancy, Random& random) {
  while (!points_.empty()) {
    const auto index = random.below(points_.size());
    if (occupancy.admits_seed(points_[index])) return points_[index];
    points_[index] = points_.back();
    points_.pop_back();
  }
  return std::nullopt;
}

}  // namespace pectinate::detail
