// SPDX-License-Identifier: MIT
#include "detail/topology.hpp"

#include <algorithm>
#include <numeric>
#include <span>

namespace pectinate::detail {
namespace {

/// Disjoint sets with path halving; the smallest member represents its set.
class UnionFind {
 public:
  explicit UnionFind(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }
  std::int32_t find(std::int32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::int32_t i, std::int32_t j) {
    i = find(i);
    j = find(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<std::int32_t> parent_;
};

struct Side {
  std::int32_t triangle;
  std::int8_t side;
};

/// The sides at each vertex that is their lower end: by the other end, then by triangle. One is a number, the other end
/// times 2^32 plus 3 triangle + side: such numbers sort fast and take little memory.
class SidesByEnds {
 public:
  SidesByEnds(const std::vector<Triangle>& triangles, std::size_t vertex_count)
      : offsets_(vertex_count + 1, 0), sides_(3 * triangles.size()) {
    for (const auto& [a, b, c] : triangles) {
      for (const auto low : {std::min(a, b), std::min(b, c), std::min(c, a)}) offsets_[low + 1] += 1;
    }
    std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
    auto next = offsets_;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]);
        sides_[next[low]++] = static_cast<std::uint64_t>(high) << 32 | (3 * t + k);
      }
    }
    for (std::size_t v = 0; v < vertex_count; ++v) {
      std::sort(sides_.begin() + offsets_[v], sides_.begin() + offsets_[v + 1]);
    }
  }

  std::span<const std::uint64_t> of(std::size_t vertex) const {
    return {sides_.data() + offsets_[vertex], sides_.data() + offsets_[vertex + 1]};
  }
  static std::int32_t high_end(std::uint64_t side) { return static_cast<std::int32_t>(side >> 32); }
  static Side side(std::uint64_t side) {
    const auto code = static_cast<std::uint32_t>(side);
    return {static_cast<std::int32_t>(code / 3), static_cast<std::int8_t>(code % 3)};
  }

 private:
  std::vector<std::int32_t> offsets_;
  std::vector<std::uint64_t> sides_;
};

void join_sides(const Side& a, const Side& b, Topology& topology) {
  topology.neighbours[a.triangle][a.side] = {b.triangle, b.side};
  topology.neighbours[b.triangle][b.side] = {a.triangle, a.side};
  const int along_a = topology.side_runs_along[a.triangle] >> a.side & 1;
  const int along_b = topology.side_runs_along[b.triangle] >> b.side & 1;
  if (along_a != along_b) return;
  topology.side_runs_alike[a.triangle] |= static_cast<std::uint8_t>(1 << a.side);
  topology.side_runs_alike[b.triangle] |= static_cast<std::uint8_t>(1 << b.side);
}

/// The corner (3 t + k) of a side's triangle that lies at `vertex`.
std::int32_t corner_at(const std::vector<Triangle>& triangles, const Side& side, std::int32_t vertex) {
  const int k = triangles[side.triangle][side.side] == vertex ? side.side : (side.side + 1) % 3;
  return 3 * side.triangle + k;
}

/// The fans of triangles: corners joined across joined sides.
UnionFind find_fans(const std::vector<Triangle>& triangles,
                    const std::vector<std::array<SideNeighbour, 3>>& neighbours) {
  UnionFind fans(3 * triangles.size());
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(triangles.size()); ++t) {
    for (std::int8_t k = 0; k < 3; ++k) {
      const auto [u, m] = neighbours[t][k];
      if (u < t) continue;
      const Side other{u, m};
      for (const int end : {int{k}, (k + 1) % 3}) {
        fans.join(3 * t + end, corner_at(triangles, other, triangles[t][end]));
      }
    }
  }
  return fans;
}

/// An edge with more than two triangles.
struct CutEdge {
  std::array<std::int32_t, 2> ends;
  std::vector<Side> sides;
};

/// Joins those two triangles of a cut edge whose fans meet at both of its ends.
void rejoin_slits(const std::vector<Triangle>& triangles, const std::vector<CutEdge>& cuts, Topology& topology) {
  if (cuts.empty()) return;
  auto fans = find_fans(triangles, topology.neighbours);
  const auto is_open = [&](const Side& side) { return topology.neighbours[side.triangle][side.side].triangle < 0; };
  for (const auto& [ends, sides] : cuts) {
    const auto same_fans = [&](const Side& a, const Side& b) {
      return std::all_of(ends.begin(), ends.end(), [&](auto vertex) {
        return fans.find(corner_at(triangles, a, vertex)) == fans.find(corner_at(triangles, b, vertex));
      });
    };
    for (std::size_t i = 0; i < sides.size(); ++i) {
      for (auto j = i + 1; j < sides.size(); ++j) {
        if (is_open(sides[i]) && is_open(sides[j]) && same_fans(sides[i], sides[j])) {
          join_sides(sides[i], sides[j], topology);
        }
      }
    }
  }
}

/// Finds fans, each once: from one of its corners around the vertex, across the sides that are joined.
class FanFinder {
 public:
  struct Corner {
    std::int32_t triangle;
    int corner;
  };

  FanFinder(const std::vector<Triangle>& triangles, const std::vector<std::array<SideNeighbour, 3>>& neighbours)
      : triangles_(triangles), neighbours_(neighbours), seen_(triangles.size(), 0) {}

  bool was_seen(std::int32_t t, int k) const { return seen_[t] >> k & 1; }

  /// All corners of a fan, given one.
  const std::vector<Corner>& find(std::int32_t t, int k) {
    fan_.clear();
    add(t, k);
    const auto vertex = triangles_[t][k];
    go(vertex, {t, static_cast<std::int8_t>(k)});
    go(vertex, {t, static_cast<std::int8_t>((k + 2) % 3)});
    return fan_;
  }

 private:
  void add(std::int32_t t, int k) {
    seen_[t] |= static_cast<std::uint8_t>(1 << k);
    fan_.push_back({t, k});
  }

  /// Around a vertex, across a side and on.
  void go(std::int32_t vertex, Side side) {
    while (true) {
      const auto [t, m] = neighbours_[side.triangle][side.side];
      if (t < 0) return;
      const int k = triangles_[t][m] == vertex ? m : (m + 1) % 3;
      if (was_seen(t, k)) return;
      add(t, k);
      side = {t, static_cast<std::int8_t>(m == k ? (k + 2) % 3 : k)};
    }
  }

  const std::vector<Triangle>& triangles_;
  const std::vector<std::array<SideNeighbour, 3>>& neighbours_;
  std::vector<std::uint8_t> seen_;  // a bit for each corner
  std::vector<Corner> fan_;
};

}  // namespace

Topology make_topology(const TriangleSoup& soup) {
  const auto& triangles = soup.triangles;
  const SidesByEnds sides(triangles, soup.vertices.size());
  Topology topology;
  topology.triangle_edges.resize(triangles.size());
  topology.neighbours.resize(triangles.size());
  topology.side_runs_along.resize(triangles.size());
  topology.side_runs_alike.resize(triangles.size());
  topology.edge_triangles.reserve(3 * triangles.size());
  // Half the sides, those at borders and cuts once more: the rest may grow.
  const auto likely_edges = 3 * triangles.size() / 2 + soup.vertices.size() / 8;
  topology.edges.reserve(likely_edges);
  topology.edge_offsets.reserve(likely_edges + 1);
  std::vector<CutEdge> cuts;
  for (std::int32_t low = 0; low < static_cast<std::int32_t>(soup.vertices.size()); ++low) {
    const auto here = sides.of(low);
    for (std::size_t first = 0, last = 0; first < here.size(); first = last) {
      const auto high = SidesByEnds::high_end(here[first]);
      const auto edge = static_cast<std::int32_t>(topology.edges.size());
      topology.edges.push_back({low, high});
      topology.edge_offsets.push_back(static_cast<std::int32_t>(topology.edge_triangles.size()));
      for (; last < here.size() && SidesByEnds::high_end(here[last]) == high; ++last) {
        const auto [t, k] = SidesByEnds::side(here[last]);
        topology.triangle_edges[t][k] = edge;
        topology.edge_triangles.push_back(t);
        topology.side_runs_along[t] |= static_cast<std::uint8_t>((triangles[t][k] == low) << k);
      }
      if (last - first == 2) join_sides(SidesByEnds::side(here[first]), SidesByEnds::side(here[first + 1]), topology);
      if (last - first > 2) {
        topology.cut_edges.push_back(edge);
        auto& cut = cuts.emplace_back(CutEdge{{low, high}, {}});
        for (auto i = first; i < last; ++i) cut.sides.push_back(SidesByEnds::side(here[i]));
      }
    }
  }
  topology.edge_offsets.push_back(static_cast<std::int32_t>(topology.edge_triangles.size()));
  rejoin_slits(triangles, cuts, topology);
  return topology;
}

TriangleSoup split_vertices(TriangleSoup soup, const Topology& topology) {
  auto& triangles = soup.triangles;
  FanFinder fans(triangles, topology.neighbours);
  std::vector<bool> taken(soup.vertices.size(), false);
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (fans.was_seen(t, k)) continue;
      const auto vertex = triangles[t][k];
      const auto& fan = fans.find(t, k);
      if (!taken[vertex]) {
        taken[vertex] = true;
        continue;
      }
      const auto copy = static_cast<std::int32_t>(soup.vertices.size());
      for (const auto& [triangle, corner] : fan) triangles[triangle][corner] = copy;
      soup.vertices.push_back(Vec3(soup.vertices[vertex]));
      soup.input_vertex.push_back(std::int32_t(soup.input_vertex[vertex]));
      soup.repairs.split_vertices.push_back(soup.input_vertex[vertex]);
    }
  }
  return soup;
}

}  // namespace pectinate::detail
