// SPDX-License-Identifier: MIT
#include "detail/topology.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "detail/fans.hpp"

namespace pectinate::detail {
namespace {

/// Swapping corners 1 and 2 reverses a triangle; its sides then come in this order.
constexpr std::array<int, 3> reversed_side = {2, 1, 0};

/// A side at the vertex that is its lower end. Sorted as numbers they are sorted by the other end, then by triangle.
struct LowSide {
  std::uint64_t code;

  LowSide() = default;
  LowSide(std::uint32_t high_end, std::uint32_t number)
      : code(static_cast<std::uint64_t>(high_end) << 32 | static_cast<std::uint64_t>(number) << 1) {}

  std::int32_t high_end() const { return static_cast<std::int32_t>(code >> 32); }
  std::int32_t number() const { return static_cast<std::int32_t>(static_cast<std::uint32_t>(code) >> 1); }
  void mark_as_leaving() { code |= 1; }
  bool is_leaving() const { return code & 1; }
  bool operator<(const LowSide& other) const { return code < other.code; }
};

/// What will be written of a side is fetched so many sides ahead; as many dummies follow the last one.
constexpr std::size_t fetched_ahead = 64;

/// Puts two in order. Without a branch, because wrong guesses would cost more.
inline void sort_two(LowSide& a, LowSide& b) {
  const auto difference = static_cast<std::int64_t>(b.code - a.code);  // codes leave the sign's bit free
  const auto surplus = static_cast<std::uint64_t>(difference & difference >> 63);
  a.code += surplus;
  b.code -= surplus;
}

/// By insertion, all the way down.
inline void sort_few(LowSide* sides, std::size_t count) {
  for (std::size_t i = 1; i < count; ++i) {
    for (auto j = i; j > 0; --j) sort_two(sides[j - 1], sides[j]);
  }
}

/// The sides at each vertex that is their lower end: those that leave it, then those that arrive there.
class SidesByEnds {
 public:
  SidesByEnds(const std::vector<Triangle>& triangles, std::size_t vertex_count, Scratch& scratch)
      : ends_(scratch.array<std::uint32_t>(2 * vertex_count + 1, 0)),
        sides_(scratch.array<LowSide>(3 * triangles.size() + fetched_ahead)) {
    std::ranges::fill(sides_.last(fetched_ahead), LowSide(0, 0));
    // Filling moves each bucket's end from where its sides begin to where they end.
    for (const auto& [a, b, c] : triangles) {
      ends_[Ends(a, b).bucket + 1] += 1;
      ends_[Ends(b, c).bucket + 1] += 1;
      ends_[Ends(c, a).bucket + 1] += 1;
    }
    std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
    std::uint32_t number = 0;
    for (const auto& [a, b, c] : triangles) {
      add({a, b}, number);
      add({b, c}, number + 1);
      add({c, a}, number + 2);
      number += 4;
    }
  }

  std::span<LowSide> leaving(std::size_t vertex) { return bucket(2 * vertex); }
  std::span<LowSide> arriving(std::size_t vertex) { return bucket(2 * vertex + 1); }

 private:
  /// Which one is the lower is anyone's guess, so there is no branch.
  struct Ends {
    std::uint32_t high, bucket;
    Ends(std::int32_t from, std::int32_t to) {
      const auto difference = to - from, descends = difference >> 31;  // all bits or none
      high = static_cast<std::uint32_t>(to - (difference & descends));
      bucket = static_cast<std::uint32_t>(2 * (from + (difference & descends)) - descends);
    }
  };

  void add(const Ends& ends, std::uint32_t number) { sides_[ends_[ends.bucket]++] = {ends.high, number}; }
  std::span<LowSide> bucket(std::size_t i) {
    return {sides_.data() + (i == 0 ? 0 : ends_[i - 1]), sides_.data() + ends_[i]};
  }

  std::span<std::uint32_t> ends_;
  std::span<LowSide> sides_;
};

/// What is stored for a side of such a number.
template <class T>
T& at_side(std::vector<std::array<T, 3>>& rows, std::int32_t number) {
  return rows[number >> 2][number & 3];
}

void join_sides(std::int32_t a, std::int32_t b, bool run_alike, Topology& topology) {
  at_side(topology.neighbours, a) = {b, run_alike};
  at_side(topology.neighbours, b) = {a, run_alike};
}

/// Makes edges of sides, from vertices to higher ones, in ascending order.
class EdgeMaker {
 public:
  EdgeMaker(const TriangleSoup& soup, Topology room) : topology_(std::move(room)) {
    topology_.triangle_edges.assign(soup.triangles.size(), {});
    topology_.neighbours.assign(soup.triangles.size(), {});
    const auto likely_edges = likely_edge_count(soup.vertices.size(), soup.triangles.size());
    topology_.edges.resize(likely_edges);
    topology_.edge_sides.resize(likely_edges);
    topology_.cut_edges.clear();
    topology_.border_triangles.clear();
  }

  /// All from one vertex. The sides that leave it and those that arrive lie behind each other in memory.
  void add(std::int32_t low, std::span<LowSide> leaving, std::span<LowSide> arriving) {
    make_place(leaving.size() + arriving.size());
    if (leaving.size() == arriving.size() && add_pairs(low, leaving, arriving)) return;
    for (auto& side : leaving) side.mark_as_leaving();
    const std::span<LowSide> sides{leaving.data(), arriving.data() + arriving.size()};
    constexpr std::size_t few = 16;
    sides.size() <= few ? sort_few(sides.data(), sides.size()) : std::sort(sides.begin(), sides.end());
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
      while (last < sides.size() && sides[last].high_end() == sides[first].high_end()) ++last;
      add_edge(low, sides.subspan(first, last - first));
    }
  }

  Topology take() && {
    auto& borders = topology_.border_triangles;
    std::ranges::sort(borders);
    borders.erase(std::unique(borders.begin(), borders.end()), borders.end());
    topology_.edges.resize(count_);
    topology_.edge_sides.resize(count_);
    return std::move(topology_);
  }

 private:
  void make_place(std::size_t count) {
    if (count_ + count <= topology_.edges.size()) return;
    topology_.edges.resize(2 * (count_ + count));
    topology_.edge_sides.resize(2 * (count_ + count));
  }

  /// Where every edge has one side that leaves and one that arrives, as at nearly all vertices of most surfaces.
  bool add_pairs(std::int32_t low, std::span<const LowSide> leaving, std::span<const LowSide> arriving) {
    switch (leaving.size()) {
      case 0:
        return true;
      case 1:
        return add_pairs<1>(low, leaving.data(), arriving.data());
      case 2:
        return add_pairs<2>(low, leaving.data(), arriving.data());
      case 3:
        return add_pairs<3>(low, leaving.data(), arriving.data());
      case 4:
        return add_pairs<4>(low, leaving.data(), arriving.data());
      case 5:
        return add_pairs<5>(low, leaving.data(), arriving.data());
      case 6:
        return add_pairs<6>(low, leaving.data(), arriving.data());
      default:
        return false;
    }
  }
  template <int Count>
  bool add_pairs(std::int32_t low, const LowSide* leaving, const LowSide* arriving) {
    std::array<LowSide, Count> here, there;
    std::copy_n(leaving, Count, here.begin());
    std::copy_n(arriving, Count, there.begin());
    sort_few(here.data(), Count);
    sort_few(there.data(), Count);
    std::uint64_t difference = 0;
    bool is_repeated = false;
    for (int i = 0; i < Count; ++i) difference |= here[i].code ^ there[i].code;
    for (int i = 1; i < Count; ++i) is_repeated |= here[i].high_end() == here[i - 1].high_end();
    if (difference >> 32 != 0 || is_repeated) return false;
    const auto first = static_cast<std::int32_t>(count_);
    count_ += Count;
    for (int i = 0; i < 2 * Count; ++i) fetch(leaving[i + fetched_ahead].number());
    for (int i = 0; i < Count; ++i) {
      const auto a = here[i].number(), b = there[i].number();
      topology_.edges[first + i] = {low, here[i].high_end()};
      topology_.edge_sides[first + i] = std::min(a, b);
      at_side(topology_.triangle_edges, a) = first + i;
      at_side(topology_.triangle_edges, b) = first + i;
      join_sides(a, b, false, topology_);
    }
    return true;
  }

  /// What is written of a side lies anywhere in memory.
  void fetch(std::int32_t number) {
    __builtin_prefetch(&at_side(topology_.triangle_edges, number), 1);
    __builtin_prefetch(&at_side(topology_.neighbours, number), 1);
  }

  /// The edge that some sides are.
  void add_edge(std::int32_t low, std::span<const LowSide> sides) {
    const auto edge = static_cast<std::int32_t>(count_++);
    topology_.edges[edge] = {low, sides[0].high_end()};
    for (const auto& side : sides) {
      at_side(topology_.triangle_edges, side.number()) = edge;
      if (sides.size() != 2) topology_.border_triangles.push_back(side.number() >> 2);
    }
    if (sides.size() <= 2) {
      topology_.edge_sides[edge] = sides[0].number();
      if (sides.size() == 2) {
        join_sides(sides[0].number(), sides[1].number(), sides[0].is_leaving() == sides[1].is_leaving(), topology_);
      }
      return;
    }
    topology_.edge_sides[edge] = ~static_cast<std::int32_t>(topology_.cut_edges.size());
    auto& cut = topology_.cut_edges.emplace_back(CutEdge{edge, {}});
    for (const auto& side : sides) cut.sides.push_back(side.number());
  }

  Topology topology_;
  std::size_t count_ = 0;  // of edges
};

}  // namespace

Topology join_triangles(const TriangleSoup& soup, Topology room, Scratch& scratch) {
  scratch.next_step();
  SidesByEnds sides(soup.triangles, soup.vertices.size(), scratch);
  EdgeMaker edges(soup, std::move(room));
  for (std::int32_t low = 0; low < static_cast<std::int32_t>(soup.vertices.size()); ++low) {
    edges.add(low, sides.leaving(low), sides.arriving(low));
  }
  return std::move(edges).take();
}

std::size_t scratch_size(std::size_t vertex_count, std::size_t triangle_count) {
  constexpr std::size_t lost_between = 128;
  return (2 * vertex_count + 1) * sizeof(std::int32_t) + (3 * triangle_count + fetched_ahead) * sizeof(LowSide) +
         lost_between;
}

std::vector<std::int32_t> likely_repetitions(const Topology& topology) {
  std::vector<std::int32_t> likely;
  std::int32_t t = 0;
  for (const auto& [a, b, c] : topology.neighbours) {
    const auto x = a.triangle(), y = b.triangle(), z = c.triangle();
    // One branch for most, and a rare one.
    if (((x == y) | (y == z) | (z == x)) &&
        ((x == y && a.exists()) || (y == z && b.exists()) || (z == x && c.exists()))) {
      likely.push_back(t);
    }
    ++t;
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
  for (const auto& [a, b] : slits) {
    join_sides(4 * a.triangle() + a.side(), 4 * b.triangle() + b.side(), a.leaves() == b.leaves(), topology);
  }
  return topology;
}

SplitSoup split_vertices(TriangleSoup soup, const Topology& topology, Scratch& scratch) {
  SplitSoup result{std::move(soup), {}};
  auto& triangles = result.soup.triangles;
  auto& vertices = result.soup.vertices;
  auto& input_vertex = result.soup.input_vertex;
  if (has_one_fan_everywhere(triangles, topology.neighbours, topology.border_triangles, vertices.size(), scratch)) {
    return result;
  }
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
