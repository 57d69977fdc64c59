// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace pectinate::detail {

/// In which order the columns of a sparse symmetric matrix are eliminated, and which of them waits for which.
struct EliminationTree {
  std::vector<std::int32_t> order;   ///< node per place; a tree's places are consecutive, its root last
  std::vector<std::int32_t> parent;  ///< place per place, greater than its own; -1 for a root
};

/// METIS's order of nested dissection for the graph with the given edges, renumbered along its tree.
EliminationTree make_elimination_tree(std::int32_t node_count, std::span<const std::array<std::int32_t, 2>> edges);

}  // namespace pectinate::detail
