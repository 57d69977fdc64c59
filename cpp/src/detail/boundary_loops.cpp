// SPDX-License-Identifier: MIT
#include "detail/boundary_loops.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "detail/vec.hpp"

namespace pectinate::detail {
namespace {

BoundaryLoop measure(std::vector<std::int32_t> loop, const std::vector<Vec3>& vertices, std::int32_t component) {
  double length = 0;
  Vector moment = Vector::Zero(), low = vector(vertices[loop[0]]), high = low;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector a = vector(vertices[loop[i]]), b = vector(vertices[loop[(i + 1) % loop.size()]]);
    const double piece = (b - a).norm();
    length += piece;
    moment += piece * (a + b) / 2;
    low = low.cwiseMin(a);
    high = high.cwiseMax(a);
  }
  return {std::move(loop), length, (high - low).norm(), vec3(moment / length), component};
}

constexpr std::int32_t none = -1;

/// A vertex of a border and the ones beside it.
struct Link {
  std::array<std::int32_t, 2> next{none, none};
  std::int32_t component = none;
  bool is_seen = false;
};

/// Triangle and side, in ascending order.
std::vector<std::pair<std::int32_t, int>> find_border_sides(const Neighbours& neighbours,
                                                            const std::vector<std::int32_t>& border_triangles) {
  std::vector<std::pair<std::int32_t, int>> sides;
  for (const auto t : border_triangles) {
    for (int k = 0; k < 3; ++k) {
      if (!neighbours[t][k].exists()) sides.emplace_back(t, k);
    }
  }
  return sides;
}

/// The vertices of borders.
class Links {
 public:
  Links(std::size_t vertex_count, std::size_t border_count, Scratch& scratch)
      : link_of_(scratch.array<std::int32_t>(vertex_count, none)) {
    links_.reserve(border_count);
  }

  bool has(std::int32_t vertex) const { return link_of_[vertex] != none; }
  Link& at(std::int32_t vertex) { return links_[link_of_[vertex]]; }
  Link& make(std::int32_t vertex) {
    if (!has(vertex)) {
      link_of_[vertex] = static_cast<std::int32_t>(links_.size());
      links_.emplace_back();
    }
    return at(vertex);
  }

 private:
  std::span<std::int32_t> link_of_;
  std::vector<Link> links_;
};

}  // namespace

std::vector<BoundaryLoop> find_boundary_loops(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                              const Neighbours& neighbours,
                                              const std::vector<std::int32_t>& border_triangles,
                                              const std::vector<std::int32_t>& triangle_components, Scratch& scratch) {
  scratch.next_step();
  const auto sides = find_border_sides(neighbours, border_triangles);
  if (sides.empty()) return {};
  // One fan a vertex means two border ends at a border vertex, whatever the windings: the borders are cycles.
  Links links(vertices.size(), sides.size(), scratch);
  for (const auto& [t, k] : sides) {
    const auto a = triangles[t][k], b = triangles[t][(k + 1) % 3];
    // The end that the side leaves through comes first where it is free, so that loops run with their triangles.
    auto& from = links.make(a);
    from.next = {b, from.next[0]};
    from.component = triangle_components[t];
    auto& to = links.make(b);  // on a Moebius strip two sides may arrive at a vertex and none leave it
    to.next[to.next[0] == none ? 0 : 1] = a;
    to.component = triangle_components[t];
  }
  std::vector<BoundaryLoop> loops;
  for (std::int32_t start = 0; start < static_cast<std::int32_t>(vertices.size()); ++start) {
    if (!links.has(start) || links.at(start).is_seen) continue;
    std::vector<std::int32_t> loop;
    for (std::int32_t v = start, previous = links.at(start).next[1]; !links.at(v).is_seen;) {
      auto& link = links.at(v);
      link.is_seen = true;
      loop.push_back(v);
      const auto following = link.next[0] == previous ? link.next[1] : link.next[0];
      previous = v;
      v = following;
    }
    loops.push_back(measure(std::move(loop), vertices, links.at(start).component));
  }
  std::stable_sort(loops.begin(), loops.end(), [](const auto& a, const auto& b) { return a.length > b.length; });
  return loops;
}

}  // namespace pectinate::detail
