// SPDX-License-Identifier: MIT
#include "detail/edge_search.hpp"

#include "detail/edge_point.hpp"

namespace pectinate::detail {

EdgeSearch::EdgeSearch(const SurfaceMesh& mesh)
    : mesh_(mesh), triangle_round_(mesh.triangle_count(), 0), edge_round_(mesh.edges().size(), 0) {}

const std::vector<EdgeSearch::Found>& EdgeSearch::near_segment(const Streamline& streamline, std::size_t segment,
                                                               double radius) {
  const Capsule capsule{position(mesh_, streamline.points[segment]), position(mesh_, streamline.points[segment + 1]),
                        radius};
  found_.clear();
  queue_.clear();
  ++round_;
  reach(streamline.triangles[segment]);
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    for (const auto edge : mesh_.triangle_edges()[queue_[i]]) {
      if (edge_round_[edge] == round_) continue;
      edge_round_[edge] = round_;
      examine(edge, capsule);
    }
  }
  return found_;
}

void EdgeSearch::reach(std::int32_t triangle) {
  if (triangle_round_[triangle] == round_) return;
  triangle_round_[triangle] = round_;
  queue_.push_back(triangle);
}

void EdgeSearch::examine(std::int32_t edge, const Capsule& capsule) {
  const auto [a, b] = mesh_.edges()[edge];
  const Vector p = vector(mesh_.vertices()[a]), e = vector(mesh_.vertices()[b]) - p;
  const double length = mesh_.edge_lengths()[edge];
  // Most edges lie wholly inside or outside; how far their midpoint is tells.
  const double distance = distance_to_segment(p + e / 2, capsule.start, capsule.end);
  if (distance - length / 2 > capsule.radius + length) return;
  if (distance + length / 2 <= capsule.radius) {
    found_.push_back({edge, {0, 1}});
  } else if (distance - length / 2 <= capsule.radius) {
    if (const auto interval = intersect(capsule, p, e)) found_.push_back({edge, *interval});
  }
  for (const auto triangle : mesh_.edge_triangles(edge)) reach(triangle);
}

}  // namespace pectinate::detail
