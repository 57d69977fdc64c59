// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "meshes.hpp"

/// Triangles of a soup that meet elsewhere than in common corners and sides: every near pair is tried.
namespace pectinate::test {

using Corners = std::array<detail::Vector, 3>;

inline Corners corners_of(const Soup& soup, const Triangle& triangle) {
  return {detail::vector(soup.vertices[triangle[0]]), detail::vector(soup.vertices[triangle[1]]),
          detail::vector(soup.vertices[triangle[2]])};
}

/// Six times the volume of a tetrahedron.
inline double volume(const detail::Vector& a, const detail::Vector& b, const detail::Vector& c,
                     const detail::Vector& d) {
  return (b - a).cross(c - a).dot(d - a);
}

/// Whether a line in the plane of a triangle keeps the segment from p to q away from it; lines are its sides and pq.
inline bool parted_in_plane(const detail::Vector& p, const detail::Vector& q, const Corners& t) {
  const detail::Vector normal = (t[1] - t[0]).cross(t[2] - t[0]);
  for (const detail::Vector side : {t[1] - t[0], t[2] - t[1], t[0] - t[2], q - p}) {
    const detail::Vector across = normal.cross(side);
    const auto [low, high] = std::minmax({across.dot(t[0]), across.dot(t[1]), across.dot(t[2])});
    const auto [from, to] = std::minmax({across.dot(p), across.dot(q)});
    if (to < low || high < from) return true;
  }
  return false;
}

/// Touching counts.
inline bool pierces(const detail::Vector& p, const detail::Vector& q, const Corners& t) {
  const double p_side = volume(t[0], t[1], t[2], p), q_side = volume(t[0], t[1], t[2], q);
  const double rounding = 1e-10 * std::pow((t[1] - t[0]).norm(), 3);
  if (std::abs(p_side) < rounding && std::abs(q_side) < rounding) return !parted_in_plane(p, q, t);
  if (p_side * q_side > 0) return false;
  const std::array<double, 3> turns{volume(p, q, t[0], t[1]), volume(p, q, t[1], t[2]), volume(p, q, t[2], t[0])};
  const auto [least, most] = std::minmax_element(turns.begin(), turns.end());
  return *least >= 0 || *most <= 0;
}

/// Whether a side of `a` that has no corner in common with `b` pierces `b`.
inline bool side_pierces(const Soup& soup, const Triangle& a, const Triangle& b) {
  for (int k = 0; k < 3; ++k) {
    const auto from = a[k], to = a[(k + 1) % 3];
    const bool shared =
        std::any_of(b.begin(), b.end(), [&](std::int32_t corner) { return corner == from || corner == to; });
    if (shared) continue;
    if (pierces(detail::vector(soup.vertices[from]), detail::vector(soup.vertices[to]), corners_of(soup, b)))
      return true;
  }
  return false;
}

inline bool triangles_cross(const Soup& soup, const Triangle& a, const Triangle& b) {
  const auto shared = std::count_if(a.begin(), a.end(), [&](auto v) { return std::count(b.begin(), b.end(), v) > 0; });
  if (shared < 2) return side_pierces(soup, a, b) || side_pierces(soup, b, a);
  const Corners p = corners_of(soup, a), q = corners_of(soup, b);  // neighbours: folded onto each other?
  return shared == 3 || (p[1] - p[0]).cross(p[2] - p[0]).dot((q[1] - q[0]).cross(q[2] - q[0])) <= 0;
}

/// Pairs of triangles, the smaller index first.
inline std::set<std::array<int, 2>> crossing_triangles(const Soup& soup, double cell_size) {
  std::map<std::array<int, 3>, std::vector<int>> cells;
  std::set<std::array<int, 2>> crossing;
  const auto cell = [&](double x) { return static_cast<int>(std::floor(x / cell_size)); };
  for (int t = 0; t < static_cast<int>(soup.triangles.size()); ++t) {
    const Corners corners = corners_of(soup, soup.triangles[t]);
    const detail::Vector low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const detail::Vector high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    for (int i = cell(low.x()); i <= cell(high.x()); ++i)
      for (int j = cell(low.y()); j <= cell(high.y()); ++j)
        for (int k = cell(low.z()); k <= cell(high.z()); ++k) {
          auto& others = cells[{i, j, k}];
          for (const int other : others)
            if (triangles_cross(soup, soup.triangles[other], soup.triangles[t])) crossing.insert({other, t});
          others.push_back(t);
        }
  }
  return crossing;
}

}  // namespace pectinate::test
