// SPDX-License-Identifier: MIT
#include "detail/topology.hpp"

#include <algorithm>
#include <numeric>
#include <span>

namespace pectinate::detail {
namespace {

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

struct Corner {
  std::int32_t triangle;
  int corner;

  bool operator==(const Corner&) const = default;
};

/// The corner of a side's triangle that lies at one of the side's ends.
Corner corner_at(const std::vector<Triangle>& triangles, const Side& side, std::int32_t vertex) {
  const int k = triangles[side.triangle][side.side] == vertex ? side.side : (side.side + 1) % 3;
  return {side.triangle, k};
}

using Neighbours = std::vector<std::array<SideNeighbour, 3>>;

/// Calls visit(corner) for all corners of the fan of triangles around a vertex, given one of them: across the sides
/// that are joined, until a border or once round.
template <class Visit>
void visit_fan(const std::vector<Triangle>& triangles, const Neighbours& neighbours, const Corner& start,
               const Visit& visit) {
  const auto vertex = triangles[start.triangle][start.corner];
  visit(start);
  for (const int first : {start.corner, (start.corner + 2) % 3}) {
    auto side = first;
    for (auto t = start.triangle; neighbours[t][side].triangle >= 0;) {
      const auto [next, m] = neighbours[t][side];
      const auto corner = corner_at(triangles, {next, m}, vertex);
      if (corner == start) return;
      visit(corner);
      t = next;
      side = m == corner.corner ? (corner.corner + 2) % 3 : corner.corner;
    }
  }
}

/// An edge with more than two triangles.
struct CutEdge {
  std::array<std::int32_t, 2> ends;
  std::vector<Side> sides;
};

/// Joins those two triangles of a cut edge whose fans meet at both of its ends, before any are joined.
void rejoin_slits(const std::vector<Triangle>& triangles, const std::vector<CutEdge>& cuts, Topology& topology) {
  const auto share_fan = [&](const Side& a, const Side& b, std::int32_t vertex) {
    const auto goal = corner_at(triangles, b, vertex);
    bool is_met = false;
    visit_fan(triangles, topology.neighbours, corner_at(triangles, a, vertex),
              [&](const Corner& corner) { is_met = is_met || corner == goal; });
    return is_met;
  };
  std::vector<std::array<Side, 2>> slits;
  for (const auto& [ends, sides] : cuts) {
    std::vector<bool> is_joined(sides.size(), false);
    for (std::size_t i = 0; i < sides.size(); ++i) {
      for (auto j = i + 1; j < sides.size(); ++j) {
        if (is_joined[i] || is_joined[j]) continue;
        if (!share_fan(sides[i], sides[j], ends[0]) || !share_fan(sides[i], sides[j], ends[1])) continue;
        is_joined[i] = is_joined[j] = true;
        slits.push_back({sides[i], sides[j]});
      }
    }
  }
  for (const auto& [a, b] : slits) join_sides(a, b, topology);
}

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
  std::vector<std::uint8_t> seen(triangles.size(), 0);  // a bit for each corner
  std::vector<bool> taken(soup.vertices.size(), false);
  std::vector<Corner> fan;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (seen[t] >> k & 1) continue;
      const auto vertex = triangles[t][k];
      fan.clear();
      visit_fan(triangles, topology.neighbours, {t, k}, [&](const Corner& corner) {
        seen[corner.triangle] |= static_cast<std::uint8_t>(1 << corner.corner);
        fan.push_back(corner);
      });
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
