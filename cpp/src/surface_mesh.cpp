// SPDX-License-Identifier: MIT
#include "pectinate/surface_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "detail/boundary_loops.hpp"
#include "detail/large_array.hpp"
#include "detail/orient.hpp"
#include "detail/scratch.hpp"
#include "detail/topology.hpp"
#include "detail/triangle_soup.hpp"
#include "detail/vec.hpp"

namespace pectinate {
namespace {

using detail::vector;

/// Triangles in ascending order that are in the one list or in the other, but not in both.
std::vector<std::int32_t> in_one(const std::vector<std::int32_t>& some, const std::vector<std::int32_t>& others) {
  std::vector<std::int32_t> result;
  std::ranges::set_symmetric_difference(some, others, std::back_inserter(result));
  return result;
}

/// Everything about components but their genus, which hangs on their loops.
std::vector<SurfaceComponent> measure_components(const std::vector<std::int32_t>& triangle_components,
                                                 const std::vector<bool>& orientable,
                                                 const std::vector<double>& areas) {
  std::vector<SurfaceComponent> components(orientable.size());
  for (std::size_t first = 0, last = 0; first < areas.size(); first = last) {
    auto& component = components[triangle_components[first]];
    double sum = 0;  // of a run of triangles
    for (; last < areas.size() && triangle_components[last] == triangle_components[first]; ++last) sum += areas[last];
    component.triangle_count += last - first;
    component.area += sum;
  }
  for (std::size_t c = 0; c < components.size(); ++c) components[c].orientable = orientable[c];
  return components;
}

std::vector<std::int32_t> count_vertices(const std::vector<Triangle>& triangles, std::size_t vertex_count,
                                         const std::vector<std::int32_t>& triangle_components,
                                         std::size_t component_count) {
  if (component_count == 1) return {static_cast<std::int32_t>(vertex_count)};
  std::vector<std::int32_t> component_of_vertex(vertex_count), counts(component_count, 0);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const auto v : triangles[t]) component_of_vertex[v] = triangle_components[t];
  }
  for (const auto c : component_of_vertex) counts[c] += 1;
  return counts;
}

/// Sides at a border belong to one triangle, the others to two.
void count_genus(const std::vector<std::int32_t>& vertex_counts, const std::vector<BoundaryLoop>& loops,
                 std::vector<SurfaceComponent>& components) {
  std::vector<std::int32_t> border_sides(components.size(), 0);
  for (const auto& loop : loops) {
    components[loop.component].boundary_loop_count += 1;
    border_sides[loop.component] += static_cast<std::int32_t>(loop.vertices.size());
  }
  for (std::size_t c = 0; c < components.size(); ++c) {
    auto& component = components[c];
    const auto triangle_count = static_cast<std::int32_t>(component.triangle_count);
    const auto edge_count = (3 * triangle_count + border_sides[c]) / 2;
    component.euler_characteristic = vertex_counts[c] - edge_count + triangle_count;
    const auto deficit = 2 - component.euler_characteristic - component.boundary_loop_count;
    component.genus = component.orientable ? deficit / 2 : deficit;
  }
}

/// For what a mesh holds, and for what making it takes; all at once, because memory costs less so.
struct Rooms {
  detail::TriangleSoup soup;
  detail::Topology topology;
  std::vector<std::int32_t> components;
  detail::Scratch scratch;

  Rooms(std::size_t vertex_count, std::size_t triangle_count)
      : scratch(detail::scratch_size(vertex_count, triangle_count)) {
    const auto edge_count = detail::likely_edge_count(vertex_count, triangle_count);
    detail::back_together(
        {detail::make_room(soup.vertices, vertex_count), detail::make_room(soup.triangles, triangle_count),
         detail::make_room(soup.areas, triangle_count), detail::make_room(topology.edges, edge_count),
         detail::make_room(topology.triangle_edges, triangle_count), detail::make_room(topology.edge_sides, edge_count),
         detail::make_room(topology.neighbours, triangle_count), detail::make_room(components, triangle_count)});
  }
};

}  // namespace

SurfaceMesh::SurfaceMesh(std::span<const Vec3> vertices, std::span<const Triangle> triangles)
    : input_vertex_count_(vertices.size()), input_triangle_count_(triangles.size()) {
  detail::check_sizes(vertices.size(), triangles.size());
  // There may be many vertices that no triangle uses; those in use are hardly ever more than triangles.
  Rooms rooms(std::min(vertices.size(), triangles.size()), triangles.size());
  auto soup = detail::clean_triangle_soup(vertices, triangles, std::move(rooms.soup), rooms.scratch);
  auto topology = detail::join_triangles(soup, std::move(rooms.topology), rooms.scratch);
  const auto repetitions = detail::find_repetitions(soup, detail::likely_repetitions(topology));
  if (!repetitions.empty()) {
    soup = detail::drop_repetitions(std::move(soup), repetitions);
    topology = detail::join_triangles(soup, std::move(topology), rooms.scratch);
  }
  for (const auto& cut : topology.cut_edges) {
    const auto [a, b] = topology.edges[cut.edge];
    soup.repairs.non_manifold_edges.push_back(
        {detail::input_index(soup.input_vertex, a), detail::input_index(soup.input_vertex, b)});
    auto& around = cut_triangles_.emplace_back();
    for (const auto side : cut.sides) around.push_back(side >> 2);
  }
  topology = detail::rejoin_slits(std::move(topology), soup);
  first_copy_ = static_cast<std::int32_t>(soup.vertices.size());
  auto split = detail::split_vertices(std::move(soup), topology, rooms.scratch);

  vertices_ = std::move(split.soup.vertices);
  triangles_ = std::move(split.soup.triangles);
  areas_ = std::move(split.soup.areas);
  input_vertex_ = std::move(split.soup.input_vertex);
  input_triangle_ = std::move(split.soup.input_triangle);
  repairs_ = std::move(split.soup.repairs);
  copied_vertices_ = std::move(split.copied_vertices);
  triangle_components_ = std::move(rooms.components);
  orient(topology, rooms.scratch);
  edges_ = std::move(topology.edges);
  triangle_edges_ = std::move(topology.triangle_edges);
  edge_sides_ = std::move(topology.edge_sides);
  neighbours_ = std::move(topology.neighbours);
  for (const auto& component : components_) area_ += component.area;
}

void SurfaceMesh::orient(detail::Topology& topology, detail::Scratch& scratch) {
  auto orientation = detail::find_orientation(topology.neighbours, std::move(triangle_components_), scratch);
  auto& reversed = orientation.to_reverse;
  for (const auto t : reversed) detail::reverse_triangle(t, triangles_, topology);
  triangle_components_ = std::move(orientation.triangle_components);
  const auto find_loops = [&] {
    return detail::find_boundary_loops(vertices_, triangles_, topology.neighbours, topology.border_triangles,
                                       triangle_components_, scratch);
  };
  loops_ = find_loops();
  components_ = measure_components(triangle_components_, orientation.orientable, areas_);
  const auto inwards = detail::points_inwards(vertices_, triangles_, triangle_components_, components_, loops_);
  if (std::ranges::find(inwards, true) != inwards.end()) {
    std::vector<std::int32_t> inside_out;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(triangles_.size()); ++t) {
      if (inwards[triangle_components_[t]]) inside_out.push_back(t);
    }
    for (const auto t : inside_out) detail::reverse_triangle(t, triangles_, topology);
    reversed = in_one(reversed, inside_out);
    loops_ = find_loops();  // they run with their triangles
  }
  for (const auto t : reversed) repairs_.reversed_triangles.push_back(input_triangle_of(t));
  count_genus(count_vertices(triangles_, vertices_.size(), triangle_components_, components_.size()), loops_,
              components_);
}

double SurfaceMesh::edge_length(std::int32_t edge) const {
  const auto& [a, b] = edges_[edge];
  return (vector(vertices_[b]) - vector(vertices_[a])).norm();
}

Vec3 SurfaceMesh::triangle_normal(std::int32_t triangle) const {
  const auto& [a, b, c] = triangles_[triangle];
  const detail::Vector normal =
      (vector(vertices_[b]) - vector(vertices_[a])).cross(vector(vertices_[c]) - vector(vertices_[a]));
  return detail::vec3(normal / (2 * areas_[triangle]));
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
