// SPDX-License-Identifier: MIT
#include "pectinate/surface_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "detail/boundary_loops.hpp"
#include "detail/orient.hpp"
#include "detail/topology.hpp"
#include "detail/triangle_soup.hpp"
#include "detail/vec.hpp"

namespace pectinate {
namespace {

using detail::vector;

/// Swapping corners 1 and 2 reverses a triangle; its sides then come in this order.
constexpr std::array<std::int8_t, 3> reversed_side = {2, 1, 0};

void reverse_triangles(const std::vector<bool>& reverse, std::vector<Triangle>& triangles, detail::Topology& topology) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (reverse[t]) {
      std::swap(triangles[t][1], triangles[t][2]);
      std::swap(topology.triangle_edges[t][0], topology.triangle_edges[t][2]);
      std::swap(topology.neighbours[t][0], topology.neighbours[t][2]);
      const int along = topology.side_runs_along[t];
      topology.side_runs_along[t] = static_cast<std::uint8_t>(~((along >> 2 & 1) | (along & 2) | (along & 1) << 2) & 7);
    }
    for (auto& across : topology.neighbours[t]) {
      if (across.triangle >= 0 && reverse[across.triangle]) across.side = reversed_side[across.side];
    }
  }
}

std::vector<SurfaceComponent> count_components(const std::vector<Triangle>& triangles, std::size_t vertex_count,
                                               const std::vector<std::array<SideNeighbour, 3>>& neighbours,
                                               const std::vector<double>& areas, const std::vector<BoundaryLoop>& loops,
                                               const detail::Orientation& orientation) {
  std::vector<SurfaceComponent> components(orientation.orientable.size());
  std::vector<std::int32_t> half_edges(components.size(), 0);  // twice the number of edges
  std::vector<std::int32_t> component_of_vertex(vertex_count, -1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto c = orientation.triangle_components[t];
    components[c].triangle_count += 1;
    components[c].area += areas[t];
    for (std::size_t k = 0; k < 3; ++k) {
      half_edges[c] += neighbours[t][k].triangle < 0 ? 2 : 1;
      component_of_vertex[triangles[t][k]] = c;
    }
  }
  for (const auto c : component_of_vertex) components[c].euler_characteristic += 1;
  for (const auto& loop : loops) components[loop.component].boundary_loop_count += 1;
  for (std::size_t c = 0; c < components.size(); ++c) {
    auto& component = components[c];
    component.euler_characteristic += static_cast<std::int32_t>(component.triangle_count) - half_edges[c] / 2;
    component.orientable = orientation.orientable[c];
    const auto deficit = 2 - component.euler_characteristic - component.boundary_loop_count;
    component.genus = component.orientable ? deficit / 2 : deficit;
  }
  return components;
}

}  // namespace

SurfaceMesh::SurfaceMesh(std::span<const Vec3> vertices, std::span<const Triangle> triangles)
    : input_vertex_count_(vertices.size()), input_triangle_count_(triangles.size()) {
  auto soup = detail::clean_triangle_soup(vertices, triangles);
  auto topology = detail::make_topology(soup);
  for (const auto edge : topology.cut_edges) {
    const auto [a, b] = topology.edges[edge];
    soup.repairs.non_manifold_edges.push_back({soup.input_vertex[a], soup.input_vertex[b]});
  }
  soup = detail::split_vertices(std::move(soup), topology);

  auto orientation = detail::find_orientation(topology);
  loops_ =
      detail::find_boundary_loops(soup.vertices, soup.triangles, topology.neighbours, orientation.triangle_components);
  const auto inwards = detail::points_inwards(soup.vertices, soup.triangles, topology.neighbours, orientation, loops_);
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    if (inwards[orientation.triangle_components[t]]) orientation.reverse[t] = !orientation.reverse[t];
    if (orientation.reverse[t]) soup.repairs.reversed_triangles.push_back(soup.input_triangle[t]);
  }
  reverse_triangles(orientation.reverse, soup.triangles, topology);
  // Loops run with their triangles, so they are walked once more where windings changed.
  if (!soup.repairs.reversed_triangles.empty()) {
    loops_ = detail::find_boundary_loops(soup.vertices, soup.triangles, topology.neighbours,
                                         orientation.triangle_components);
  }

  vertices_ = std::move(soup.vertices);
  triangles_ = std::move(soup.triangles);
  input_vertex_ = std::move(soup.input_vertex);
  input_triangle_ = std::move(soup.input_triangle);
  repairs_ = std::move(soup.repairs);
  edges_ = std::move(topology.edges);
  triangle_edges_ = std::move(topology.triangle_edges);
  edge_offsets_ = std::move(topology.edge_offsets);
  edge_triangles_ = std::move(topology.edge_triangles);
  neighbours_ = std::move(topology.neighbours);
  side_runs_along_ = std::move(topology.side_runs_along);
  triangle_components_ = orientation.triangle_components;
  measure();
  components_ = count_components(triangles_, vertices_.size(), neighbours_, areas_, loops_, orientation);
}

void SurfaceMesh::measure() {
  areas_.reserve(triangles_.size());
  normals_.reserve(triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& [a, b, c] = triangles_[t];
    const detail::Vector normal =
        (vector(vertices_[b]) - vector(vertices_[a])).cross(vector(vertices_[c]) - vector(vertices_[a]));
    const double twice_area = normal.norm();
    areas_.push_back(twice_area / 2);
    normals_.push_back(detail::vec3(normal / twice_area));
    area_ += areas_.back();
  }
  edge_lengths_.reserve(edges_.size());
  for (const auto& [a, b] : edges_) {
    edge_lengths_.push_back((vector(vertices_[b]) - vector(vertices_[a])).norm());
  }
}

double SurfaceMesh::bounding_box_diagonal() const {
  detail::Vector low = vector(vertices_[0]), high = low;
  for (const auto& v : vertices_) {
    low = low.cwiseMin(vector(v));
    high = high.cwiseMax(vector(v));
  }
  return (high - low).norm();
}

}  // namespace pectinate
