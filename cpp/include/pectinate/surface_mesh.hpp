// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pectinate/mesh_rows.hpp"
#include "pectinate/types.hpp"

namespace pectinate {

namespace detail {
class Scratch;
struct Topology;
}  // namespace detail

/// What was changed to make a surface of the input; every index is one of the input's.
struct MeshRepairs {
  std::vector<std::int32_t> degenerate_triangles;   ///< dropped: a repeated corner, or no finite area
  std::vector<std::int32_t> duplicate_triangles;    ///< dropped: the same three corners as an earlier triangle
  std::vector<std::int32_t> non_finite_vertices;    ///< dropped, with the triangles that use them
  std::vector<std::int32_t> non_finite_triangles;   ///< dropped: a corner is not finite
  std::vector<std::int32_t> unreferenced_vertices;  ///< dropped: no kept triangle uses them
  std::vector<std::int32_t> reversed_triangles;     ///< kept, winding reversed to agree with their component
  std::vector<std::array<std::int32_t, 2>> non_manifold_edges;  ///< cut open: more than two triangles met there
  std::vector<std::int32_t> split_vertices;                     ///< duplicated: their triangles form more than one fan
};

/// A closed border of the surface.
struct BoundaryLoop {
  std::vector<std::int32_t> vertices;  ///< mesh vertices in order, no repetition
  double length;                       ///< sum of the edge lengths
  double diameter;                     ///< diagonal of the bounding box
  Vec3 centroid;                       ///< of the curve, weighted by length
  std::int32_t component;
};

/// A maximal set of triangles joined across edges.
struct SurfaceComponent {
  std::size_t triangle_count;
  double area;
  std::int32_t euler_characteristic;  ///< V - E + F
  std::int32_t boundary_loop_count;
  bool orientable;
  std::int32_t genus;  ///< number of handles; of cross-caps when not orientable
};

/// A triangulated surface made of any triangle soup: cut open where it is no manifold, consistently oriented where it
/// can be, with areas, normals and adjacency. Immutable.
///
/// Kept triangles stay in input order. An edge is geometric: all triangles that share two input vertices share one
/// edge, also where the surface was cut; `neighbour` is topological and ends at cuts. Orientation: neighbours agree;
/// a component whose volume (its openings closed by fans) is well defined has outward normals, any other follows the
/// majority of its input windings (design after "Surfaces as they are").
class SurfaceMesh {
 public:
  /// `vertices` in any unit of length, `triangles` index them. Throws InvalidMesh for an index out of range or when
  /// no valid triangle is left.
  SurfaceMesh(std::span<const Vec3> vertices, std::span<const Triangle> triangles);

  const std::vector<Vec3>& vertices() const { return vertices_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  std::size_t triangle_count() const { return triangles_.size(); }

  /// The input's counts and, for each vertex and triangle here, its index there. What comes as a ComputedRow, here and
  /// below, is not stored: its elements are made one by one as they are asked for.
  std::size_t input_vertex_count() const { return input_vertex_count_; }
  std::size_t input_triangle_count() const { return input_triangle_count_; }
  std::int32_t input_vertex_of(std::int32_t vertex) const {
    return input_vertex_.empty() ? vertex : input_vertex_[vertex];
  }
  std::int32_t input_triangle_of(std::int32_t triangle) const {
    return input_triangle_.empty() ? triangle : input_triangle_[triangle];
  }
  auto input_vertex() const { return ComputedRow<&SurfaceMesh::input_vertex_of>(*this, vertices_.size()); }
  auto input_triangle() const { return ComputedRow<&SurfaceMesh::input_triangle_of>(*this, triangles_.size()); }
  const MeshRepairs& repairs() const { return repairs_; }

  /// Geometric edges: their end vertices (one copy of each where the surface was cut) and lengths.
  const std::vector<std::array<std::int32_t, 2>>& edges() const { return edges_; }
  double edge_length(std::int32_t edge) const;
  auto edge_lengths() const { return ComputedRow<&SurfaceMesh::edge_length>(*this, edges_.size()); }
  /// Per triangle, the edge of each side.
  const std::vector<std::array<std::int32_t, 3>>& triangle_edges() const { return triangle_edges_; }
  /// All triangles at an edge: one, two, or more where it was cut.
  EdgeTriangles edge_triangles(std::int32_t edge) const {
    const auto first = edge_sides_[edge];
    if (first < 0) return EdgeTriangles(cut_triangles_[~first]);
    const auto across = neighbours_[first >> 2][first & 3];
    return across.exists() ? EdgeTriangles(first >> 2, across.triangle()) : EdgeTriangles(first >> 2);
  }
  /// True where corner `side` of the triangle is the first end vertex of the edge of side `side`.
  bool runs_along(std::int32_t triangle, int side) const {
    const auto& corners = triangles_[triangle];
    return uncopied(corners[side]) < uncopied(corners[side == 2 ? 0 : side + 1]);
  }
  /// The same for all three sides, by bit.
  unsigned sides_running_along(std::int32_t triangle) const {
    const auto& corners = triangles_[triangle];
    const auto a = uncopied(corners[0]), b = uncopied(corners[1]), c = uncopied(corners[2]);
    return static_cast<unsigned>(a < b) | static_cast<unsigned>(b < c) << 1 | static_cast<unsigned>(c < a) << 2;
  }
  SideNeighbour neighbour(std::int32_t triangle, int side) const { return neighbours_[triangle][side].unpacked(); }

  const std::vector<double>& triangle_areas() const { return areas_; }
  Vec3 triangle_normal(std::int32_t triangle) const;  ///< unit
  auto triangle_normals() const { return ComputedRow<&SurfaceMesh::triangle_normal>(*this, triangles_.size()); }
  const std::vector<std::int32_t>& triangle_components() const { return triangle_components_; }
  double area() const { return area_; }
  double bounding_box_diagonal() const;

  const std::vector<SurfaceComponent>& components() const { return components_; }
  const std::vector<BoundaryLoop>& boundary_loops() const { return loops_; }  ///< longest first

 private:
  void orient(detail::Topology& topology, detail::Scratch& scratch);
  /// Of a vertex that was duplicated, the first copy.
  std::int32_t uncopied(std::int32_t vertex) const {
    const auto copy = vertex - first_copy_;
    return copy < 0 ? vertex : copied_vertices_[copy];
  }

  std::vector<Vec3> vertices_;
  std::vector<Triangle> triangles_;
  std::size_t input_vertex_count_, input_triangle_count_;
  std::vector<std::int32_t> input_vertex_, input_triangle_;  // empty where they count up
  MeshRepairs repairs_;
  std::int32_t first_copy_ = 0;                // vertices from here on are copies
  std::vector<std::int32_t> copied_vertices_;  // of these
  std::vector<std::array<std::int32_t, 2>> edges_;
  std::vector<std::array<std::int32_t, 3>> triangle_edges_;
  std::vector<std::int32_t> edge_sides_;  // 4 triangle + side of the first triangle; where it was cut ~i, i of
  std::vector<std::vector<std::int32_t>> cut_triangles_;
  std::vector<std::array<PackedNeighbour, 3>> neighbours_;
  std::vector<double> areas_;
  std::vector<std::int32_t> triangle_components_;
  double area_ = 0;
  std::vector<SurfaceComponent> components_;
  std::vector<BoundaryLoop> loops_;
};

}  // namespace pectinate
