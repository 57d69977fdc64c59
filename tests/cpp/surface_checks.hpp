// SPDX-License-Identifier: MIT
#pragma once

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>
#include <set>
#include <vector>

#include "meshes.hpp"
#include "pectinate/surface_mesh.hpp"

/// What is true of every surface.
namespace pectinate::test {

using Indices = std::vector<std::int32_t>;
using Pair = std::array<std::int32_t, 2>;

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

inline Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

inline Triangle input_corners(const SurfaceMesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles()[t];
  return {mesh.input_vertex()[a], mesh.input_vertex()[b], mesh.input_vertex()[c]};
}

/// Do three corners have the same cyclic order in both?
inline bool same_winding(Triangle a, const Triangle& b) {
  for (int k = 0; k < 3 && a != b; ++k) std::rotate(a.begin(), a.begin() + 1, a.end());
  return a == b;
}

inline double signed_volume(const SurfaceMesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles()) {
    volume += detail::vector(mesh.vertices()[a])
                  .dot(detail::vector(mesh.vertices()[b]).cross(detail::vector(mesh.vertices()[c]))) /
              6;
  }
  return volume;
}

/// The indices below `count` in none of the sets, which must not overlap.
inline Indices rest(std::size_t count, const std::vector<Indices>& sets) {
  std::vector<int> times(count, 0);
  for (const auto& set : sets) {
    for (const auto i : set) ++times[i];
  }
  CHECK(std::all_of(times.begin(), times.end(), [](int n) { return n <= 1; }));
  Indices left;
  for (std::size_t i = 0; i < count; ++i) {
    if (times[i] == 0) left.push_back(static_cast<std::int32_t>(i));
  }
  return left;
}

/// Every valid triangle is there, in input order, and everything else is accounted for.
inline void check_maps(const Soup& soup, const SurfaceMesh& mesh) {
  const auto& repairs = mesh.repairs();
  CHECK(mesh.input_triangle() == rest(soup.triangles.size(), {repairs.degenerate_triangles, repairs.duplicate_triangles,
                                                              repairs.non_finite_triangles}));
  Indices reversed;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto& given = soup.triangles[mesh.input_triangle()[t]];
    REQUIRE(sorted(input_corners(mesh, t)) == sorted(given));
    if (!same_winding(input_corners(mesh, t), given)) reversed.push_back(mesh.input_triangle()[t]);
  }
  CHECK(repairs.reversed_triangles == reversed);

  const auto kept = rest(soup.vertices.size(), {repairs.unreferenced_vertices, repairs.non_finite_vertices});
  REQUIRE(mesh.vertices().size() == kept.size() + repairs.split_vertices.size());
  const auto& map = mesh.input_vertex();
  CHECK(Indices(map.begin(), map.begin() + static_cast<std::ptrdiff_t>(kept.size())) == kept);
  CHECK(Indices(map.begin() + static_cast<std::ptrdiff_t>(kept.size()), map.end()) == repairs.split_vertices);
  for (std::size_t v = 0; v < map.size(); ++v) CHECK(mesh.vertices()[v] == soup.vertices[map[v]]);
}

/// Neighbours are mutual, share both end vertices and the edge, and agree on their winding where they can.
inline void check_neighbours(const SurfaceMesh& mesh) {
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    const bool orientable = mesh.components()[mesh.triangle_components()[t]].orientable;
    for (int k = 0; k < 3; ++k) {
      const auto [u, m] = mesh.neighbour(t, k);
      if (u < 0) continue;
      const auto back = mesh.neighbour(u, m);
      CHECK((back.triangle == t && back.side == k));
      CHECK(mesh.triangle_edges()[t][k] == mesh.triangle_edges()[u][m]);
      CHECK(mesh.triangle_components()[t] == mesh.triangle_components()[u]);
      const Pair here{mesh.triangles()[t][k], mesh.triangles()[t][(k + 1) % 3]};
      const Pair there{mesh.triangles()[u][m], mesh.triangles()[u][(m + 1) % 3]};
      const bool against = here == Pair{there[1], there[0]};
      CHECK((orientable ? against : against || here == there));
    }
  }
}

/// Edges are geometric: one for each pair of input vertices, with all triangles that have it.
inline void check_edges(const SurfaceMesh& mesh) {
  const auto& map = mesh.input_vertex();
  std::set<Pair> seen;
  std::size_t sides = 0;
  for (std::size_t e = 0; e < mesh.edges().size(); ++e) {
    const auto [a, b] = mesh.edges()[e];
    CHECK(seen.insert({std::min(map[a], map[b]), std::max(map[a], map[b])}).second);
    CHECK(mesh.edge_lengths()[e] == (detail::vector(mesh.vertices()[b]) - detail::vector(mesh.vertices()[a])).norm());
    for (const auto t : mesh.edge_triangles(static_cast<std::int32_t>(e))) {
      ++sides;
      const auto& edges = mesh.triangle_edges()[t];
      const auto k =
          static_cast<int>(std::find(edges.begin(), edges.end(), static_cast<std::int32_t>(e)) - edges.begin());
      REQUIRE(k < 3);
      const Triangle corners = input_corners(mesh, t);
      const Pair ends{corners[k], corners[(k + 1) % 3]};
      CHECK(ends == (mesh.runs_along(t, k) ? Pair{map[a], map[b]} : Pair{map[b], map[a]}));
    }
  }
  CHECK(sides == 3 * mesh.triangle_count());
}

/// Walking from neighbour to neighbour around a vertex meets all of its triangles.
inline void check_one_fan_a_vertex(const SurfaceMesh& mesh) {
  std::vector<Indices> around(mesh.vertices().size());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    for (const auto v : mesh.triangles()[t]) around[v].push_back(static_cast<std::int32_t>(t));
  }
  for (std::size_t v = 0; v < around.size(); ++v) {
    REQUIRE(!around[v].empty());
    std::set<std::int32_t> met{around[v][0]};
    Indices queue{around[v][0]};
    while (!queue.empty()) {
      const auto t = queue.back();
      queue.pop_back();
      for (int k = 0; k < 3; ++k) {
        const auto& corners = mesh.triangles()[t];
        const bool at_vertex = corners[k] == static_cast<int>(v) || corners[(k + 1) % 3] == static_cast<int>(v);
        const auto u = mesh.neighbour(t, k).triangle;
        if (at_vertex && u >= 0 && met.insert(u).second) queue.push_back(u);
      }
    }
    CHECK(met.size() == around[v].size());
  }
}

/// Each open side belongs to one loop, once; loops of an orientable component run with their triangles.
inline void check_loops(const SurfaceMesh& mesh) {
  std::set<Pair> open;  // both ways
  std::size_t open_count = 0;
  std::set<Pair> forwards;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (mesh.neighbour(t, k).triangle >= 0) continue;
      ++open_count;
      const Pair side{mesh.triangles()[t][k], mesh.triangles()[t][(k + 1) % 3]};
      forwards.insert(side);
      open.insert(side);
      open.insert({side[1], side[0]});
    }
  }
  std::size_t walked = 0;
  std::set<std::int32_t> vertices;
  double longest = std::numeric_limits<double>::infinity();
  for (const auto& loop : mesh.boundary_loops()) {
    double length = 0;
    REQUIRE(loop.vertices.size() >= 3);
    for (std::size_t i = 0; i < loop.vertices.size(); ++i, ++walked) {
      const Pair step{loop.vertices[i], loop.vertices[(i + 1) % loop.vertices.size()]};
      CHECK(vertices.insert(step[0]).second);
      CHECK((mesh.components()[loop.component].orientable ? forwards : open).contains(step));
      length += (detail::vector(mesh.vertices()[step[1]]) - detail::vector(mesh.vertices()[step[0]])).norm();
    }
    CHECK(loop.length == doctest::Approx(length).epsilon(1e-14));
    CHECK(loop.length <= longest);
    longest = loop.length;
  }
  CHECK(walked == open_count);
}

inline void check_components(const SurfaceMesh& mesh) {
  const auto count = mesh.components().size();
  std::vector<std::size_t> triangle_counts(count, 0);
  std::vector<double> areas(count, 0);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto component = mesh.triangle_components()[t];
    triangle_counts[component] += 1;
    areas[component] += mesh.triangle_areas()[t];
  }
  int loops = 0;
  for (std::size_t c = 0; c < count; ++c) {
    const auto& component = mesh.components()[c];
    CHECK(component.triangle_count == triangle_counts[c]);
    CHECK(component.area == doctest::Approx(areas[c]).epsilon(1e-12));
    loops += component.boundary_loop_count;
    CHECK(component.genus >= (component.orientable ? 0 : 1));
    const int handles = component.orientable ? 2 * component.genus : component.genus;
    CHECK(component.euler_characteristic == 2 - handles - component.boundary_loop_count);
  }
  const double area = std::accumulate(mesh.triangle_areas().begin(), mesh.triangle_areas().end(), 0.0);
  CHECK(mesh.area() == doctest::Approx(area).epsilon(1e-12));
  CHECK(loops == static_cast<int>(mesh.boundary_loops().size()));
}

/// The mesh of a soup, with all that is true of every surface checked.
inline SurfaceMesh checked(const Soup& soup) {
  SurfaceMesh mesh = soup.mesh();
  CHECK(mesh.input_vertex_count() == soup.vertices.size());
  CHECK(mesh.input_triangle_count() == soup.triangles.size());
  check_maps(soup, mesh);
  check_neighbours(mesh);
  check_edges(mesh);
  check_one_fan_a_vertex(mesh);
  check_loops(mesh);
  check_components(mesh);
  return mesh;
}

}  // namespace pectinate::test
