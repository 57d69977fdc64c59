// SPDX-License-Identifier: MIT
#include "detail/orient.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "detail/vec.hpp"

namespace pectinate::detail {
namespace {

/// Below this volume over area^1.5 (a sphere has 0.094) inside and outside are no matter of the surface's shape.
constexpr double least_relative_volume = 1e-3;

}  // namespace

Orientation find_orientation(const Topology& topology) {
  constexpr std::int32_t none = -1;
  const auto& neighbours = topology.neighbours;
  const auto count = static_cast<std::int32_t>(neighbours.size());
  Orientation result{std::vector<std::int32_t>(count, none), {}, std::vector<bool>(count, false)};
  std::vector<std::int32_t> members;
  members.reserve(count);
  for (std::int32_t start = 0; start < count; ++start) {
    if (result.triangle_components[start] != none) continue;
    const auto component = static_cast<std::int32_t>(result.orientable.size());
    result.orientable.push_back(true);
    result.triangle_components[start] = component;
    members.assign(1, start);
    std::size_t reversed = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const auto t = members[i];
      const bool is_reversed = result.reverse[t];
      reversed += is_reversed;
      for (int k = 0; k < 3; ++k) {
        const auto other = neighbours[t][k].triangle;
        if (other < 0) continue;
        const bool reverse = is_reversed != static_cast<bool>(topology.side_runs_alike[t] >> k & 1);
        if (result.triangle_components[other] == none) {
          result.triangle_components[other] = component;
          result.reverse[other] = reverse;
          members.push_back(other);
          __builtin_prefetch(&neighbours[other]);  // by the time its turn comes it will be at hand
        } else if (result.reverse[other] != reverse) {
          result.orientable.back() = false;
        }
      }
    }
    if (2 * reversed > members.size()) {
      for (const auto t : members) result.reverse[t] = !result.reverse[t];
    }
  }
  return result;
}

std::vector<bool> points_inwards(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                 const std::vector<std::array<SideNeighbour, 3>>& neighbours,
                                 const Orientation& orientation, const std::vector<BoundaryLoop>& loops) {
  const auto component_count = orientation.orientable.size();
  std::vector<double> volume(component_count, 0), area(component_count, 0);
  std::vector<Vector> origin(component_count, Vector::Zero());
  for (std::size_t t = triangles.size(); t-- > 0;) {
    origin[orientation.triangle_components[t]] = vector(vertices[triangles[t][0]]);
  }
  std::vector<std::int32_t> loop_of_vertex(vertices.size(), -1);
  for (std::size_t l = 0; l < loops.size(); ++l) {
    for (const auto v : loops[l].vertices) loop_of_vertex[v] = static_cast<std::int32_t>(l);
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto component = orientation.triangle_components[t];
    const auto corner = [&](std::size_t k) -> Vector {
      return vector(vertices[triangles[t][k % 3]]) - origin[component];
    };
    const double sign = orientation.reverse[t] ? -1 : 1;
    const Vector normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    area[component] += normal.norm() / 2;
    volume[component] += sign * corner(0).dot(normal) / 6;
    for (std::size_t k = 0; k < 3; ++k) {
      if (neighbours[t][k].triangle >= 0) continue;
      const Vector apex = vector(loops[loop_of_vertex[triangles[t][k]]].centroid) - origin[component];
      volume[component] += sign * apex.dot(corner(k + 1).cross(corner(k))) / 6;
    }
  }
  std::vector<bool> inwards(component_count);
  for (std::size_t c = 0; c < component_count; ++c) {
    inwards[c] = orientation.orientable[c] && volume[c] < -least_relative_volume * std::pow(area[c], 1.5);
  }
  return inwards;
}

}  // namespace pectinate::detail
