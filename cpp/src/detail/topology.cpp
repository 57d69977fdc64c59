// SPDX-License-Identifier: MIT
#include "detail/topology.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "detail/buckets.hpp"

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
  std::array<std::int32_t, 2> ends;  ///< soup vertices, the smaller first
  std::int32_t triangle;
  std::int8_t side;
};

/// By their ends, then by triangle.
std::vector<Side> sorted_sides(const std::vector<Triangle>& triangles, std::size_t vertex_count) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(triangles.size()); ++t) {
    for (std::int8_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]);
      sides.push_back({{low, high}, t, k});
    }
  }
  Buckets<Side> by_low_end(sides, vertex_count, [](const Side& side) { return side.ends[0]; });
  for (std::size_t v = 0; v < by_low_end.count(); ++v) {
    const auto bucket = by_low_end.bucket(v);
    std::sort(bucket.begin(), bucket.end(), [](const Side& a, const Side& b) {
      return a.ends[1] != b.ends[1] ? a.ends[1] < b.ends[1] : a.triangle < b.triangle;
    });
  }
  return std::move(by_low_end).take();
}

void join_sides(std::vector<std::array<SideNeighbour, 3>>& neighbours, const Side& a, const Side& b) {
  neighbours[a.triangle][a.side] = {b.triangle, b.side};
  neighbours[b.triangle][b.side] = {a.triangle, a.side};
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
      const Side other{{}, u, m};
      for (const int end : {int{k}, (k + 1) % 3}) {
        fans.join(3 * t + end, corner_at(triangles, other, triangles[t][end]));
      }
    }
  }
  return fans;
}

/// Joins those two triangles of a cut edge whose fans meet at both of its ends.
void rejoin_slits(const std::vector<Triangle>& triangles, const std::vector<Side>& sides,
                  const std::vector<std::pair<std::size_t, std::size_t>>& cut_ranges,
                  std::vector<std::array<SideNeighbour, 3>>& neighbours) {
  if (cut_ranges.empty()) return;
  auto fans = find_fans(triangles, neighbours);
  const auto same_fans = [&](const Side& a, const Side& b) {
    return std::all_of(a.ends.begin(), a.ends.end(), [&](auto vertex) {
      return fans.find(corner_at(triangles, a, vertex)) == fans.find(corner_at(triangles, b, vertex));
    });
  };
  for (const auto& [first, last] : cut_ranges) {
    for (auto i = first; i < last; ++i) {
      for (auto j = i + 1; j < last; ++j) {
        const bool both_open = neighbours[sides[i].triangle][sides[i].side].triangle < 0 &&
                               neighbours[sides[j].triangle][sides[j].side].triangle < 0;
        if (both_open && same_fans(sides[i], sides[j])) join_sides(neighbours, sides[i], sides[j]);
      }
    }
  }
}

}  // namespace

Topology make_topology(const TriangleSoup& soup) {
  const auto& triangles = soup.triangles;
  const auto sides = sorted_sides(triangles, soup.vertices.size());
  Topology topology;
  topology.triangle_edges.resize(triangles.size());
  topology.neighbours.resize(triangles.size());
  topology.edge_triangles.reserve(sides.size());
  std::vector<std::pair<std::size_t, std::size_t>> cut_ranges;
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    const auto edge = static_cast<std::int32_t>(topology.edges.size());
    topology.edges.push_back(sides[first].ends);
    topology.edge_offsets.push_back(static_cast<std::int32_t>(first));
    for (; last < sides.size() && sides[last].ends == sides[first].ends; ++last) {
      topology.triangle_edges[sides[last].triangle][sides[last].side] = edge;
      topology.edge_triangles.push_back(sides[last].triangle);
    }
    if (last - first == 2) join_sides(topology.neighbours, sides[first], sides[first + 1]);
    if (last - first > 2) {
      topology.cut_edges.push_back(edge);
      cut_ranges.emplace_back(first, last);
    }
  }
  topology.edge_offsets.push_back(static_cast<std::int32_t>(sides.size()));
  rejoin_slits(triangles, sides, cut_ranges, topology.neighbours);
  return topology;
}

TriangleSoup split_vertices(TriangleSoup soup, const Topology& topology) {
  auto fans = find_fans(soup.triangles, topology.neighbours);
  constexpr std::int32_t none = -1;
  std::vector<std::int32_t> fan_vertex(3 * soup.triangles.size(), none);
  std::vector<bool> taken(soup.vertices.size(), false);
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      auto& vertex = soup.triangles[t][k];
      auto& assigned = fan_vertex[fans.find(static_cast<std::int32_t>(3 * t + k))];
      if (assigned == none) {
        assigned = vertex;
        if (taken[vertex]) {
          assigned = static_cast<std::int32_t>(soup.vertices.size());
          soup.vertices.push_back(Vec3(soup.vertices[vertex]));
          soup.input_vertex.push_back(std::int32_t(soup.input_vertex[vertex]));
          soup.repairs.split_vertices.push_back(soup.input_vertex[vertex]);
        } else {
          taken[vertex] = true;
        }
      }
      vertex = assigned;
    }
  }
  return soup;
}

}  // namespace pectinate::detail
