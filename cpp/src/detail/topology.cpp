// SPDX-License-Identifier: MIT
#include "detail/topology.hpp"

#include <algorithm>
#include <numeric>
#include <span>

#include "detail/fans.hpp"
#include "detail/large_array.hpp"

namespace pectinate::detail {
namespace {

/// Swapping corners 1 and 2 reverses a triangle; its sides then come in this order.
constexpr std::array<int, 3> reversed_side = {2, 1, 0};

/// A side at the vertex that is its lower end. Sorted as numbers they are sorted by the other end, then by triangle.
struct LowSide {
  std::uint64_t code;

  LowSide() = default;
  LowSide(std::int32_t high_end, std::int32_t triangle, int side, bool runs_along)
      : code(static_cast<std::uint64_t>(high_end) << 32 | static_cast<std::uint64_t>(triangle) << 3 |
             static_cast<std::uint64_t>(side) << 1 | static_cast<std::uint64_t>(runs_along)) {}

  std::int32_t high_end() const { return static_cast<std::int32_t>(code >> 32); }
  std::int32_t triangle() const { return static_cast<std::int32_t>(static_cast<std::uint32_t>(code) >> 3); }
  int side() const { return static_cast<int>(code >> 1 & 3); }
  bool runs_along() const { return code & 1; }  ///< from the lower end to the higher one
  bool operator<(const LowSide& other) const { return code < other.code; }
};

/// By insertion while they are few, as they are on any surface; all the way down and without branches, because wrong
/// guesses would cost more.
void sort_sides(std::span<LowSide> sides) {
  constexpr std::size_t few = 16;
  if (sides.size() > few) return std::sort(sides.begin(), sides.end());
  for (std::size_t i = 1; i < sides.size(); ++i) {
    auto least = sides[i].code;
    for (auto j = i; j > 0; --j) {
      const auto other = sides[j - 1].code;
      const auto difference =
          (least ^ other) & -static_cast<std::uint64_t>(other < least);  // if they are to be swapped
      sides[j].code = other ^ difference;
      least ^= difference;
    }
    sides[0].code = least;
  }
}

/// The sides at each vertex that is their lower end.
class SidesByEnds {
 public:
  SidesByEnds(const std::vector<Triangle>& triangles, std::size_t vertex_count) : ends_(vertex_count + 1, 0) {
    // A large page too many is gone again soon, and costs less than the many small ones of its part that is used.
    sides_.reserve(fill_large_pages<LowSide>(3 * triangles.size()));
    sides_.resize(3 * triangles.size());
    // Filling moves each vertex's end from where its sides begin to where they end.
    for (const auto& [a, b, c] : triangles) {
      ends_[std::min(a, b) + 1] += 1;
      ends_[std::min(b, c) + 1] += 1;
      ends_[std::min(c, a) + 1] += 1;
    }
    std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(triangles.size()); ++t) {
      const auto& [a, b, c] = triangles[t];
      add(a, b, t, 0);
      add(b, c, t, 1);
      add(c, a, t, 2);
    }
  }

  /// In ascending order. To be asked for all vertices in turn.
  std::span<const LowSide> sorted_at(std::size_t vertex) {
    const std::span<LowSide> sides{sides_.data() + (vertex == 0 ? 0 : ends_[vertex - 1]),
                                   sides_.data() + ends_[vertex]};
    sort_sides(sides);
    return sides;
  }

 private:
  void add(std::int32_t from, std::int32_t to, std::int32_t triangle, int side) {
    const bool runs_along = from < to;
    const auto low = runs_along ? from : to, high = runs_along ? to : from;
    sides_[ends_[low]++] = {high, triangle, side, runs_along};
  }

  std::vector<std::int32_t> ends_;
  LargeArray<LowSide> sides_;
};

template <class A, class B>
void join_sides(const A& a, const B& b, bool run_alike, Topology& topology) {
  topology.neighbours[a.triangle()][a.side()] = {b.triangle(), b.side(), run_alike};
  topology.neighbours[b.triangle()][b.side()] = {a.triangle(), a.side(), run_alike};
}

/// Adds the edge that some sides are.
void add_edge(std::int32_t low, std::span<const LowSide> sides, Topology& topology) {
  const auto edge = static_cast<std::int32_t>(topology.edges.size());
  topology.edges.push_back({low, sides[0].high_end()});
  for (const auto& side : sides) topology.triangle_edges[side.triangle()][side.side()] = edge;
  if (sides.size() <= 2) {
    topology.edge_sides.push_back(4 * sides[0].triangle() + sides[0].side());
    if (sides.size() == 2) {
      join_sides(sides[0], sides[1], sides[0].runs_along() == sides[1].runs_along(), topology);
    }
    return;
  }
  topology.edge_sides.push_back(~static_cast<std::int32_t>(topology.cut_edges.size()));
  auto& cut = topology.cut_edges.emplace_back(CutEdge{edge, {}});
  for (const auto& side : sides) cut.sides.push_back(4 * side.triangle() + side.side());
}

}  // namespace

Topology join_triangles(const TriangleSoup& soup) {
  SidesByEnds sides(soup.triangles, soup.vertices.size());
  Topology topology;
  topology.triangle_edges = roomy_vector<std::array<std::int32_t, 3>>(soup.triangles.size(), {});
  topology.neighbours = roomy_vector<std::array<PackedNeighbour, 3>>(soup.triangles.size(), {});
  // Half the sides, those at borders and cuts once more: the rest may grow.
  const auto likely_edges = 3 * soup.triangles.size() / 2 + soup.vertices.size() / 8;
  topology.edges = roomy_vector<std::array<std::int32_t, 2>>(likely_edges);
  topology.edge_sides = roomy_vector<std::int32_t>(likely_edges);
  for (std::int32_t low = 0; low < static_cast<std::int32_t>(soup.vertices.size()); ++low) {
    const auto here = sides.sorted_at(low);
    for (std::size_t first = 0, last = 0; first < here.size(); first = last) {
      while (last < here.size() && here[last].high_end() == here[first].high_end()) ++last;
      add_edge(low, here.subspan(first, last - first), topology);
    }
  }
  return topology;
}

std::vector<std::int32_t> likely_repetitions(const Topology& topology) {
  std::vector<std::int32_t> likely;
  for (std::size_t t = 0; t < topology.neighbours.size(); ++t) {
    const auto& [a, b, c] = topology.neighbours[t];
    const auto alike = [](PackedNeighbour x, PackedNeighbour y) { return x.triangle() == y.triangle() && x.exists(); };
    if (alike(a, b) || alike(b, c) || alike(c, a)) likely.push_back(static_cast<std::int32_t>(t));
  }
  for (const auto& cut : topology.cut_edges) {
    for (const auto side : cut.sides) likely.push_back(side >> 2);
  }
  std::sort(likely.begin(), likely.end());
  likely.erase(std::unique(likely.begin(), likely.end()), likely.end());
  return likely;
}

Topology rejoin_slits(Topology topology, const TriangleSoup& soup) {
  struct Slit {
    FanSide a, b;
  };
  std::vector<Slit> slits;  // to be joined in the end: fans are looked at before any are
  for (const auto& [edge, sides] : topology.cut_edges) {
    const auto low = topology.edges[edge][0];
    const auto at = [&](std::size_t i, bool at_low) {
      const FanSide side{sides[i] >> 2, sides[i] & 3, true};
      const bool leaves_low = soup.triangles[side.triangle()][side.side()] == low;
      return FanSide{side.triangle(), side.side(), leaves_low == at_low};
    };
    const auto share_fans = [&](std::size_t i, std::size_t j) {
      for (const bool at_low : {true, false}) {
        bool is_met = false;
        const auto goal = at(j, at_low).corner();
        visit_fan(topology.neighbours, at(i, at_low).corner(),
                  [&](const Corner& corner) { is_met = is_met || corner == goal; });
        if (!is_met) return false;
      }
      return true;
    };
    std::vector<bool> is_joined(sides.size(), false);
    for (std::size_t i = 0; i < sides.size(); ++i) {
      for (auto j = i + 1; j < sides.size(); ++j) {
        if (is_joined[i] || is_joined[j] || !share_fans(i, j)) continue;
        is_joined[i] = is_joined[j] = true;
        slits.push_back({at(i, true), at(j, true)});
      }
    }
  }
  for (const auto& [a, b] : slits) join_sides(a, b, a.leaves() == b.leaves(), topology);
  return topology;
}

SplitSoup split_vertices(TriangleSoup soup, const Topology& topology) {
  SplitSoup result{std::move(soup), {}};
  auto& triangles = result.soup.triangles;
  auto& vertices = result.soup.vertices;
  auto& input_vertex = result.soup.input_vertex;
  if (has_one_fan_everywhere(triangles, topology.neighbours, vertices.size())) return result;
  input_vertex = written_out(std::move(input_vertex), vertices.size());
  std::vector<std::uint8_t> seen(triangles.size(), 0);  // a bit for each corner
  std::vector<bool> taken(vertices.size(), false);
  std::vector<Corner> fan;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (seen[t] >> k & 1) continue;
      const auto vertex = triangles[t][k];
      fan.clear();
      visit_fan(topology.neighbours, {t, k}, [&](const Corner& corner) {
        seen[corner.triangle] |= static_cast<std::uint8_t>(1 << corner.corner);
        fan.push_back(corner);
      });
      if (!taken[vertex]) {
        taken[vertex] = true;
        continue;
      }
      const auto copy = static_cast<std::int32_t>(vertices.size());
      for (const auto& [triangle, corner] : fan) triangles[triangle][corner] = copy;
      vertices.push_back(Vec3(vertices[vertex]));
      input_vertex.push_back(std::int32_t(input_vertex[vertex]));
      result.soup.repairs.split_vertices.push_back(input_vertex[vertex]);
      result.copied_vertices.push_back(vertex);
    }
  }
  return result;
}

void reverse_triangle(std::int32_t t, std::vector<Triangle>& triangles, Topology& topology) {
  auto& neighbours = topology.neighbours[t];
  auto& edges = topology.triangle_edges[t];
  std::swap(triangles[t][1], triangles[t][2]);
  std::swap(edges[0], edges[2]);
  std::swap(neighbours[0], neighbours[2]);
  for (int k = 0; k < 3; ++k) {
    auto& first = topology.edge_sides[edges[k]];
    if (first >= 0 && first >> 2 == t) first = 4 * t + k;
    const auto across = neighbours[k];
    if (!across.exists()) continue;
    neighbours[k] = {across.triangle(), across.side(), !across.runs_alike()};
    topology.neighbours[across.triangle()][across.side()] = {t, k, !across.runs_alike()};
  }
}

}  // namespace pectinate::detail
