// SPDX-License-Identifier: MIT
#include "detail/elimination_tree.hpp"

#include <metis.h>

#include <numeric>
#include <string>

#include "pectinate/errors.hpp"

namespace pectinate::detail {
namespace {

using Places = std::vector<std::int32_t>;

/// The neighbours of each node, one after the other.
struct Graph {
  std::vector<idx_t> offsets, neighbours;

  Graph(std::int32_t node_count, std::span<const std::array<std::int32_t, 2>> edges)
      : offsets(node_count + 1, 0), neighbours(2 * edges.size()) {
    for (const auto& [a, b] : edges) {
      ++offsets[a + 1];
      ++offsets[b + 1];
    }
    std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
    std::vector<idx_t> next(offsets.begin(), offsets.end() - 1);
    for (const auto& [a, b] : edges) {
      neighbours[next[a]++] = b;
      neighbours[next[b]++] = a;
    }
  }

  std::int32_t node_count() const { return static_cast<std::int32_t>(offsets.size()) - 1; }
  std::span<const idx_t> of(std::int32_t node) const {
    return {neighbours.data() + offsets[node], neighbours.data() + offsets[node + 1]};
  }
};

/// The node at every place.
Places dissect(Graph& graph) {
  idx_t count = graph.node_count();
  std::vector<idx_t> order(count), place(count);
  std::iota(order.begin(), order.end(), 0);
  if (graph.neighbours.empty()) return {order.begin(), order.end()};  // which METIS does not take
  const int status =
      METIS_NodeND(&count, graph.offsets.data(), graph.neighbours.data(), nullptr, nullptr, order.data(), place.data());
  if (status != METIS_OK)
    throw SolverFailure("METIS found no order of elimination (status " + std::to_string(status) + ")");
  return {order.begin(), order.end()};
}

/// Liu, ACM Trans. Math. Softw. 1986, with path compression.
Places tree_of(const Graph& graph, const Places& order) {
  Places place(order.size()), parent(order.size(), -1), ancestor(order.size(), -1);
  for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<std::int32_t>(i);
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(order.size()); ++i) {
    for (const idx_t neighbour : graph.of(order[i])) {
      for (std::int32_t k = place[neighbour]; k >= 0 && k < i;) {
        const std::int32_t next = ancestor[k];
        ancestor[k] = i;
        if (next < 0) parent[k] = i;
        k = next;
      }
    }
  }
  return parent;
}

/// New place per old place: children directly before their parent.
Places postorder(const Places& parent) {
  Places first_child(parent.size(), -1), next_sibling(parent.size(), -1), renumbered(parent.size());
  for (std::int32_t i = static_cast<std::int32_t>(parent.size()) - 1; i >= 0; --i) {
    if (parent[i] < 0) continue;
    next_sibling[i] = first_child[parent[i]];
    first_child[parent[i]] = i;
  }
  std::int32_t count = 0;
  Places stack;
  for (std::size_t root = 0; root < parent.size(); ++root) {
    if (parent[root] >= 0) continue;
    stack.push_back(static_cast<std::int32_t>(root));
    while (!stack.empty()) {
      const std::int32_t top = stack.back(), child = first_child[top];
      if (child >= 0) {
        first_child[top] = next_sibling[child];
        stack.push_back(child);
      } else {
        renumbered[top] = count++;
        stack.pop_back();
      }
    }
  }
  return renumbered;
}

}  // namespace

EliminationTree make_elimination_tree(std::int32_t node_count, std::span<const std::array<std::int32_t, 2>> edges) {
  Graph graph(node_count, edges);
  const Places order = dissect(graph), parent = tree_of(graph, order), renumbered = postorder(parent);
  EliminationTree tree{Places(node_count), Places(node_count, -1)};
  for (std::int32_t i = 0; i < node_count; ++i) {
    tree.order[renumbered[i]] = order[i];
    if (parent[i] >= 0) tree.parent[renumbered[i]] = renumbered[parent[i]];
  }
  return tree;
}

}  // namespace pectinate::detail
