// SPDX-License-Identifier: MIT
#include "detail/boundary_loops.hpp"

#include <algorithm>

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

}  // namespace

std::vector<BoundaryLoop> find_boundary_loops(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                              const std::vector<std::array<SideNeighbour, 3>>& neighbours,
                                              const std::vector<std::int32_t>& triangle_components) {
  // One fan a vertex means two border ends at a border vertex, whatever the windings: the borders are cycles.
  constexpr std::int32_t none = -1;
  std::vector<std::array<std::int32_t, 2>> next(vertices.size(), {none, none});
  std::vector<std::int32_t> component(vertices.size(), none);
  const auto link = [&](std::int32_t from, std::int32_t to) { next[from][next[from][0] == none ? 0 : 1] = to; };
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (neighbours[t][k].triangle >= 0) continue;
      const auto a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      // The end that the side leaves through comes first where it is free, so that loops run with their triangles.
      if (next[a][0] == none) {
        next[a][0] = b;
      } else {
        next[a][1] = next[a][0];
        next[a][0] = b;
      }
      link(b, a);
      component[a] = triangle_components[t];
    }
  }
  std::vector<BoundaryLoop> loops;
  std::vector<bool> seen(vertices.size(), false);
  for (std::int32_t start = 0; start < static_cast<std::int32_t>(vertices.size()); ++start) {
    if (seen[start] || next[start][0] == none) continue;
    std::vector<std::int32_t> loop;
    for (std::int32_t v = start, previous = next[start][1]; !seen[v];) {
      seen[v] = true;
      loop.push_back(v);
      const auto following = next[v][0] == previous ? next[v][1] : next[v][0];
      previous = v;
      v = following;
    }
    loops.push_back(measure(std::move(loop), vertices, component[start]));
  }
  std::stable_sort(loops.begin(), loops.end(), [](const auto& a, const auto& b) { return a.length > b.length; });
  return loops;
}

}  // namespace pectinate::detail
