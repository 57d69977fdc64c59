// SPDX-License-Identifier: MIT
#include "detail/seed_ring.hpp"

#include <algorithm>
#include <vector>

#include "detail/edge_point.hpp"
#include "detail/random.hpp"

namespace pectinate::detail {

SeedRing::SeedRing(const SurfaceMesh& mesh, const StreamlineTracer& tracer, double factor)
    : search_(mesh), tracer_(tracer), factor_(factor), inside_round_(mesh.edges().size(), 0) {}

void SeedRing::add(const Streamline& streamline) {
  ++round_;
  partial_.clear();
  for (std::size_t segment = 0; segment < streamline.triangles.size(); ++segment) {
    const double distance = factor_ * tracer_.separation_distance(streamline.triangles[segment]);
    for (const auto& found : search_.near_segment(streamline, segment, distance)) {
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
    const auto triangle = tracer_.start_triangle(edge);
    if (triangle && position > least_position && position < 1 - least_position) {
      seeds_.push_back({{edge, position}, *triangle});
    }
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

std::optional<Seed> SeedRing::draw(const Occupancy& occupancy, Random& random) {
  while (!seeds_.empty()) {
    const auto index = random.below(seeds_.size());
    if (occupancy.admits_seed(seeds_[index])) return seeds_[index];
    seeds_[index] = seeds_.back();
    seeds_.pop_back();
  }
  return std::nullopt;
}

}  // namespace pectinate::detail
