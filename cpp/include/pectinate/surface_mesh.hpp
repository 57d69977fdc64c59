// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pectinate/types.hpp"

namespace pectinate {

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

/// A triangle's side in the surface: the triangle across it, or none.
struct SideNeighbour {
  std::int32_t triangle = -1;  ///< -1 at a border (also where a non-manifold edge was cut)
  std::int8_t side = -1;       ///< the side of that triangle
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

  /// The input's counts and, for each vertex and triangle here, its index there.
  std::size_t input_vertex_count() const { return input_vertex_count_; }
  std::size_t input_triangle_count() const { return input_triangle_count_; }
  const std::vector<std::int32_t>& input_vertex() const { return input_vertex_; }
  const std::vector<std::int32_t>& input_triangle() const { return input_triangle_; }
  const MeshRepairs& repairs() const { return repairs_; }

  /// Geometric edges: their end vertices (one copy of each where the surface was cut) and lengths.
  const std::vector<std::array<std::int32_t, 2>>& edges() const { return edges_; }
  const std::vector<double>& edge_lengths() const { return edge_lengths_; }
  /// Per triangle, the edge of each side.
  const std::vector<std::array<std::int32_t, 3>>& triangle_edges() const { return triangle_edges_; }
  /// All triangles at an edge: one, two, or more where it was cut.
  std::span<const std::int32_t> edge_triangles(std::int32_t edge) const {
    return {edge_triangles_.data() + edge_offsets_[edge], edge_triangles_.data() + edge_offsets_[edge + 1]};
  }
  /// True where corner `side` of the triangle is the first end vertex of the edge of side `side`.
  bool runs_along(std::int32_t triangle, int side) const { return side_runs_along_[triangle] >> side & 1; }
  const SideNeighbour& neighbour(std::int32_t triangle, int side) const { return neighbours_[triangle][side]; }

  const std::vector<double>& triangle_areas() const { return areas_; }
  const std::vector<Vec3>& triangle_normals() const { return normals_; }  ///< unit
  const std::vector<std::int32_t>& triangle_components() const { return triangle_components_; }
  double area() const { return area_; }
  double bounding_box_diagonal() const;

  const std::vector<SurfaceComponent>& components() const { return components_; }
  const std::vector<BoundaryLoop>& boundary_loops() const { return loops_; }  ///< longest first

 private:
  void measure();

  std::vector<Vec3> vertices_;
  std::vector<Triangle> triangles_;
  std::size_t input_vertex_count_, input_triangle_count_;
  std::vector<std::int32_t> input_vertex_, input_triangle_;
  MeshRepairs repairs_;
  std::vector<std::array<std::int32_t, 2>> edges_;
  std::vector<double> edge_lengths_;
  std::vector<std::array<std::int32_t, 3>> triangle_edges_;
  std::vector<std::int32_t> edge_offsets_, edge_triangles_;
  std::vector<std::uint8_t> side_runs_along_;
  std::vector<std::array<SideNeighbour, 3>> neighbours_;
  std::vector<double> areas_;
  std::vector<Vec3> normals_;
  std::vector<std::int32_t> triangle_components_;
  double area_ = 0;
  std::vector<SurfaceComponent> components_;
  std::vector<BoundaryLoop> loops_;
};

}  // namespace pectinate
