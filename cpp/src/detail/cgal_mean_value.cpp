// SPDX-License-Identifier: MIT
// The headers of CGAL that this file includes are GPL-3.0-or-later, and so is a library built with it.
#include <CGAL/Eigen_matrix.h>
#include <CGAL/Eigen_vector.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_parameterization/Circular_border_parameterizer_3.h>
#include <CGAL/Surface_mesh_parameterization/Fixed_border_parameterizer_3.h>

#include <memory>
#include <string>

#include "detail/dirichlet_solver.hpp"
#include "detail/mean_value.hpp"
#include "detail/mean_value_map.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::detail {
namespace {

namespace cgal = CGAL::Surface_mesh_parameterization;
using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Border = cgal::Circular_border_arc_length_parameterizer_3<Mesh>;

/// CGAL's model of a linear solver (SparseLinearAlgebraTraits_d). It is asked once per coordinate, with the same matrix
/// each time: the factorization is kept.
class KeptFactorization {
 public:
  using NT = double;
  using Matrix = CGAL::Eigen_sparse_matrix<double>;
  using Vector = CGAL::Eigen_vector<double>;

  // NOLINTNEXTLINE(readability-identifier-naming): CGAL's name
  bool linear_solver(const Matrix& matrix, const Vector& right_side, Vector& solution, NT& denominator) {
    if (!solver_) solver_ = std::make_shared<DirichletSolver>(matrix.eigen_object(), given_rows(matrix));
    solution = solver_->solve(right_side);
    denominator = 1;
    return true;
  }

 private:
  /// Rows that hold nothing but their diagonal, which is 1: border vertices.
  static std::vector<bool> given_rows(const Matrix& matrix) {
    std::vector<bool> given(matrix.row_dimension(), true);
    const auto& entries = matrix.eigen_object();
    for (Eigen::Index column = 0; column < entries.outerSize(); ++column) {
      for (Matrix::EigenType::InnerIterator entry(entries, column); entry; ++entry) {
        if (entry.row() != column) given[entry.row()] = false;
      }
    }
    return given;
  }

  std::shared_ptr<DirichletSolver> solver_;  // CGAL copies its solvers
};

/// CGAL's parameterizer with weights that stay positive and bounded where triangles have no proper shape.
class MeanValueParameterizer : public cgal::Fixed_border_parameterizer_3<Mesh, Border, KeptFactorization> {
 protected:
  // NOLINTNEXTLINE(readability-identifier-naming): CGAL's name
  NT compute_w_ij(const Mesh& mesh, Mesh::Vertex_index vertex,
                  CGAL::Vertex_around_target_circulator<Mesh> neighbour) const override {
    const Kernel::Point_3& centre = mesh.point(vertex);
    const auto spoke_to = [&](Mesh::Vertex_index end) {
      const auto spoke = mesh.point(end) - centre;
      return detail::Vector(spoke.x(), spoke.y(), spoke.z());
    };
    auto before = neighbour, after = neighbour;
    --before;
    ++after;
    const auto spoke = spoke_to(*neighbour);
    return mean_value_share(spoke, spoke_to(*before)) + mean_value_share(spoke, spoke_to(*after));
  }
};

Mesh build_mesh(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  Mesh mesh;
  for (const auto& [x, y, z] : vertices) mesh.add_vertex({x, y, z});
  const auto vertex = [](std::int32_t v) { return Mesh::Vertex_index(static_cast<Mesh::size_type>(v)); };
  for (const auto& [a, b, c] : triangles) {
    if (mesh.add_face(vertex(a), vertex(b), vertex(c)) != Mesh::null_face()) continue;
    throw InvalidMesh("a triangle cannot be joined to its neighbours when the holes are filled; remesh the surface");
  }
  return mesh;
}

}  // namespace

bool has_mean_value_map() {
  return true;
}

std::vector<DiskPoint> mean_value_map(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                      const std::vector<std::int32_t>& border) {
  Mesh mesh = build_mesh(vertices, triangles);
  // Border halfedges run against the border's triangles.
  const auto first = mesh.halfedge(Mesh::Vertex_index(static_cast<Mesh::size_type>(border.front())),
                                   Mesh::Vertex_index(static_cast<Mesh::size_type>(border.back())));
  const auto images = mesh.add_property_map<Mesh::Vertex_index, Kernel::Point_2>("image").first;
  const auto done = mesh.add_property_map<Mesh::Vertex_index, bool>("done", false).first;
  const auto error = MeanValueParameterizer().parameterize(mesh, first, images, get(boost::vertex_index, mesh), done);
  if (error != cgal::OK) {
    throw SolverFailure(std::string("the surface cannot be mapped to the disk: ") + cgal::get_error_message(error));
  }
  std::vector<DiskPoint> points;
  points.reserve(vertices.size());
  for (const auto v : mesh.vertices()) points.push_back({2 * images[v].x() - 1, 2 * images[v].y() - 1});
  return points;
}

}  // namespace pectinate::detail
