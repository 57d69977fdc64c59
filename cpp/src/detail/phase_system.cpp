// SPDX-License-Identifier: MIT
#include "detail/phase_system.hpp"

#include <algorithm>

namespace pectinate::detail {

PhaseSystem::PhaseSystem(const Connection& connection)
    : connection_(connection.edges),
      edges_of_(connection.node_count, {-1, -1, -1}),
      constraints_(connection.node_count),
      shifts_(connection.node_count, 0),
      matrix_{std::vector<double>(connection.node_count), std::vector<Phase>(connection.edges.size())},
      right_hand_side_(connection.node_count) {
  edges_.reserve(connection_.size());
  for (std::size_t e = 0; e < connection_.size(); ++e) {
    edges_.push_back({connection_[e].first, connection_[e].second});
    for (const auto node : edges_.back()) *std::ranges::find(edges_of_[node], -1) = static_cast<std::int32_t>(e);
  }
}

std::vector<std::int32_t> PhaseSystem::affected(std::span<const std::int32_t> nodes) const {
  std::vector<std::int32_t> all(nodes.begin(), nodes.end());
  for (const auto node : nodes) {
    for (const auto e : edges_of_[node]) {
      if (e >= 0) all.push_back(edges_[e][0] == node ? edges_[e][1] : edges_[e][0]);
    }
  }
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void PhaseSystem::update(std::span<const std::int32_t> rows) {
  for (const auto node : rows) {
    const auto& [target, weight] = constraints_[node];
    double diagonal = shifts_[node] + (held(node) ? 0 : weight);
    Phase pull = held(node) ? 0 : weight * target;
    for (const auto e : edges_of_[node]) {
      if (e < 0) continue;
      const ConnectionEdge& edge = connection_[e];
      const bool forth = edge.first == node;
      const std::int32_t other = forth ? edge.second : edge.first;
      diagonal += edge.weight;
      matrix_.edges[e] = held(node) || held(other) ? 0 : -edge.weight * edge.transport;
      if (held(other)) {
        pull += edge.weight * constraints_[other].target * (forth ? std::conj(edge.transport) : edge.transport);
      }
    }
    if (held(node)) {
      diagonal = std::max(diagonal, 1.0);  // of a triangle without neighbours too
      pull = diagonal * target;
    }
    matrix_.diagonal[node] = diagonal;
    right_hand_side_[node] = pull;
  }
}

}  // namespace pectinate::detail
