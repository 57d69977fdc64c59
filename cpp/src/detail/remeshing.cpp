// SPDX-License-Identifier: MIT
#include "detail/remeshing.hpp"

#include <Eigen/Geometry>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>

#include "pectinate/errors.hpp"

namespace pectinate::detail {

namespace {

constexpr int closed_iterations = 3;  // enough to give the cuts something even to cut
constexpr int open_iterations = 8;
constexpr int polishing_iterations = 5;
constexpr double mean_share = 0.937;    // of the length between splits and collapses: where edges settle in the mean
constexpr double snapping_share = 0.1;  // of the edge length: avoids slivers along the cut

struct MeshTraits : OpenMesh::DefaultTraitsDouble {
  VertexAttributes(OpenMesh::Attributes::Status);
  HalfedgeAttributes(OpenMesh::Attributes::Status);
  EdgeAttributes(OpenMesh::Attributes::Status);
  FaceAttributes(OpenMesh::Attributes::Status);
  VertexTraits {
    const Cut* border = nullptr;  // none in the interior
  };
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<MeshTraits>;
using Edge = OpenMesh::SmartEdgeHandle;
using Halfedge = OpenMesh::SmartHalfedgeHandle;
using Vertex = OpenMesh::SmartVertexHandle;

OpenMesh::Vec3d openmesh_point(const Vector& point) {
  return {point.x(), point.y(), point.z()};
}

Mesh build_mesh(const IndexedTriangles& input) {
  Mesh mesh;
  for (const Vector& vertex : input.vertices) mesh.add_vertex(openmesh_point(vertex));
  for (const auto& [a, b, c] : input.triangles)
    mesh.add_face(mesh.vertex_handle(a), mesh.vertex_handle(b), mesh.vertex_handle(c));
  return mesh;
}

Vector area_vector(const Vector& a, const Vector& b, const Vector& c) {
  return (b - a).cross(c - a);
}

bool similar_sides(const Vector& area_vector_a, const Vector& area_vector_b) {
  return area_vector_a.dot(area_vector_b) > 0.5 * area_vector_a.norm() * area_vector_b.norm();
}

double smallest_angle(const Vector& a, const Vector& b, const Vector& c) {
  const Vector ab = (b - a).normalized(), bc = (c - b).normalized(), ca = (a - c).normalized();
  return std::acos(std::min(1.0, std::max({-ab.dot(ca), -bc.dot(ab), -ca.dot(bc)})));
}

class Remesher {
 public:
  Remesher(const IndexedTriangles& closed, const ImplicitSurface& surface, double edge_length)
      : mesh_(build_mesh(closed)), surface_(surface), edge_length_(edge_length / mean_share) {}

  void improve(int iterations) {
    for (int i = 0; i < iterations; ++i) {
      split_long_edges();
      collapse_short_edges();
      flip_edges([this](Edge edge) { return flip_evens_valences(edge); });
      relax();
    }
    mesh_.garbage_collection();
  }

  void polish(int iterations) {
    for (int i = 0; i < iterations; ++i) {
      flip_edges([this](Edge edge) { return flip_opens_angles(edge); });
      relax();
    }
  }

  void cut(const Cut& cut) {
    std::vector<double> heights;
    for (const Vertex vertex : mesh_.vertices()) heights.push_back(snap(vertex, cut));
    for (const Edge edge : edges()) {
      if (heights[edge.v0().idx()] * heights[edge.v1().idx()] >= 0) continue;
      split(edge, project_to_border(surface_, cut, middle(edge)));
      heights.push_back(0);
    }
    for (const auto face : mesh_.faces())
      if (face.vertices().any_of([&](Vertex vertex) { return heights[vertex.idx()] > 0; })) mesh_.delete_face(face);
    mesh_.garbage_collection();
    for (const Vertex vertex : mesh_.vertices())
      if (vertex.is_boundary() && !border(vertex)) mesh_.data(vertex).border = &cut;
  }

  CutTriangles result() const {
    CutTriangles result;
    for (const Vertex vertex : mesh_.vertices()) result.surface.vertices.push_back(point(vertex));
    for (const auto face : mesh_.faces()) {
      const auto corners = face.vertices().to_array<3>();
      result.surface.triangles.push_back({corners[0].idx(), corners[1].idx(), corners[2].idx()});
    }
    for (const Cut& cut : surface_.cuts) result.loops.push_back(loop(cut));
    return result;
  }

 private:
  Eigen::Map<const Vector> point(Vertex vertex) const { return Eigen::Map<const Vector>(mesh_.point(vertex).data()); }
  Vector middle(Edge edge) const { return (point(edge.v0()) + point(edge.v1())) / 2; }
  Vertex split(Edge edge, const Vector& point) { return mesh_.split(edge, openmesh_point(point)); }
  const Cut* border(Vertex vertex) const { return mesh_.data(vertex).border; }

  void move(Vertex vertex, const Vector& point) { mesh_.set_point(vertex, openmesh_point(point)); }

  /// The edges of now: those that a loop over them creates are left to the next one.
  std::vector<Edge> edges() const { return mesh_.edges().to_vector(); }

  Vector on_surface(const Vector& point, const Cut* border) const {
    return border ? project_to_border(surface_, *border, point) : project(surface_, point);
  }

  /// Height above the cut, negative where out of its reach. A vertex close to the plane is moved onto it.
  double snap(Vertex vertex, const Cut& cut) {
    if (!cut.reaches(point(vertex))) return -edge_length_;
    const double height = cut.height(point(vertex));
    if (std::abs(height) > snapping_share * edge_length_) return height;
    move(vertex, project_to_border(surface_, cut, point(vertex)));
    return 0;
  }

  void split_long_edges() {
    for (const Edge edge : edges()) {
      if (mesh_.calc_edge_length(edge) < 4.0 / 3 * edge_length_) continue;
      const Cut* const edge_border = edge.is_boundary() ? border(edge.v0()) : nullptr;
      const Vertex added = split(edge, on_surface(middle(edge), edge_border));
      mesh_.data(added).border = edge_border;
    }
  }

  void collapse_short_edges() {
    for (const Edge edge : edges()) {
      if (edge.deleted() || mesh_.calc_edge_length(edge) > 4.0 / 5 * edge_length_) continue;
      if (may_collapse(edge.h0()))
        mesh_.collapse(edge.h0());
      else if (may_collapse(edge.h1()))
        mesh_.collapse(edge.h1());
    }
  }

  /// Whether the halfedge's start may move into its end without leaving its border, growing long edges or a fold.
  bool may_collapse(Halfedge halfedge) {
    const Vertex from = halfedge.from(), to = halfedge.to();
    if (from.is_boundary() && !halfedge.edge().is_boundary()) return false;
    if (!mesh_.is_collapse_ok(halfedge)) return false;
    for (const Halfedge spoke : from.outgoing_halfedges()) {
      if ((point(spoke.to()) - point(to)).norm() > 4.0 / 3 * edge_length_) return false;
      if (spoke.is_boundary() || spoke.to() == to || spoke.next().to() == to) continue;
      const Vector b = point(spoke.to()), c = point(spoke.next().to());
      if (!similar_sides(area_vector(point(from), b, c), area_vector(point(to), b, c))) return false;
    }
    return true;
  }

  template <typename Criterion>
  void flip_edges(const Criterion& criterion) {
    for (const Edge edge : edges())
      if (!edge.is_boundary() && mesh_.is_flip_ok(edge) && !flip_folds(edge) && criterion(edge)) mesh_.flip(edge);
  }

  /// The ends of an interior edge, then the corners opposite to it on its left and right.
  std::array<Vertex, 4> diamond(Edge edge) const {
    return {edge.h0().from(), edge.h0().to(), edge.h0().next().to(), edge.h1().next().to()};
  }

  bool flip_folds(Edge edge) const {
    const auto [a, b, left, right] = diamond(edge);
    const Vector new_left = area_vector(point(a), point(right), point(left));
    const Vector new_right = area_vector(point(b), point(left), point(right));
    return !similar_sides(new_left, new_right);
  }

  bool flip_evens_valences(Edge edge) const {
    const auto [a, b, left, right] = diamond(edge);
    const auto excess = [](Vertex vertex, int change) {
      return std::abs(static_cast<int>(vertex.valence()) + change - (vertex.is_boundary() ? 4 : 6));
    };
    return excess(a, -1) + excess(b, -1) + excess(left, 1) + excess(right, 1) <
           excess(a, 0) + excess(b, 0) + excess(left, 0) + excess(right, 0);
  }

  bool flip_opens_angles(Edge edge) const {
    const auto [a, b, left, right] = diamond(edge);
    const double now =
        std::min(smallest_angle(point(a), point(b), point(left)), smallest_angle(point(b), point(a), point(right)));
    const double flipped = std::min(smallest_angle(point(a), point(right), point(left)),
                                    smallest_angle(point(b), point(left), point(right)));
    return flipped > now * (1 + 1e-6);  // a tie must not flip forth and back
  }

  /// Moves each vertex to the middle of its neighbours, along the surface or its border.
  void relax() {
    std::vector<Vector> moved(mesh_.n_vertices());
    for (const Vertex vertex : mesh_.vertices()) {
      Vector sum = Vector::Zero();
      int count = 0;
      for (const Halfedge spoke : vertex.outgoing_halfedges()) {
        if (border(vertex) && !spoke.edge().is_boundary()) continue;
        sum += point(spoke.to());
        ++count;
      }
      moved[vertex.idx()] = on_surface(sum / count, border(vertex));
    }
    for (const Vertex vertex : mesh_.vertices()) move(vertex, moved[vertex.idx()]);
  }

  std::vector<std::int32_t> loop(const Cut& cut) const {
    std::vector<std::int32_t> loop;
    const auto starts_on_cut = [&](Halfedge halfedge) {
      return halfedge.is_boundary() && border(halfedge.from()) == &cut;
    };
    for (const Halfedge start : mesh_.halfedges().filtered(starts_on_cut)) {
      if (loop.empty()) {
        // Border halfedges have the surface on their right: against their order.
        Halfedge halfedge = start;
        do {
          loop.push_back(halfedge.to().idx());
          halfedge = halfedge.prev();
        } while (halfedge != start);
      }
    }
    return loop;
  }

  Mesh mesh_;
  const ImplicitSurface& surface_;
  double edge_length_;
};

/// Calls visit(a, b, cut) for each side of the loops.
template <typename Visit>
void visit_loop_sides(const CutTriangles& triangles, const Visit& visit) {
  for (std::size_t cut = 0; cut < triangles.loops.size(); ++cut) {
    const auto& loop = triangles.loops[cut];
    for (std::size_t i = 0; i < loop.size(); ++i) visit(loop[i], loop[(i + 1) % loop.size()], cut);
  }
}

/// The new vertex in the middle of each edge, by its ends, the smaller first.
using Middles = std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t>;

std::pair<std::int32_t, std::int32_t> edge_key(std::int32_t a, std::int32_t b) {
  return std::minmax({a, b});
}

}  // namespace

CutTriangles remesh(const IndexedTriangles& closed, const ImplicitSurface& surface, double edge_length) {
  Remesher remesher(closed, surface, edge_length);
  remesher.improve(closed_iterations);
  for (const Cut& cut : surface.cuts) remesher.cut(cut);
  remesher.improve(open_iterations);
  remesher.polish(polishing_iterations);
  CutTriangles result = remesher.result();
  for (const auto& loop : result.loops) {
    if (loop.empty()) throw SolverFailure("a cut through the implicit surface leaves no border; use shorter edges");
  }
  return result;
}

CutTriangles subdivide(const CutTriangles& coarse, const ImplicitSurface& surface) {
  CutTriangles fine{coarse.surface, {}};
  auto& [vertices, triangles] = fine.surface;
  Middles middles;
  const auto middle_of = [&](std::int32_t a, std::int32_t b, const Cut* border) {
    const auto [entry, is_new] = middles.try_emplace(edge_key(a, b), static_cast<std::int32_t>(vertices.size()));
    const Vector middle = (vertices[a] + vertices[b]) / 2;
    if (is_new) vertices.push_back(border ? project_to_border(surface, *border, middle) : project(surface, middle));
    return entry->second;
  };
  fine.loops.resize(coarse.loops.size());
  visit_loop_sides(coarse, [&](std::int32_t a, std::int32_t b, std::size_t cut) {
    fine.loops[cut].push_back(a);
    fine.loops[cut].push_back(middle_of(a, b, &surface.cuts[cut]));
  });
  triangles.clear();
  for (const auto& [a, b, c] : coarse.surface.triangles) {
    const auto ab = middle_of(a, b, nullptr), bc = middle_of(b, c, nullptr), ca = middle_of(c, a, nullptr);
    triangles.insert(triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return fine;
}

}  // namespace pectinate::detail
