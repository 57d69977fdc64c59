// SPDX-License-Identifier: MIT
#include "pectinate/parameterization.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "detail/hole_filling.hpp"
#include "detail/mean_value_map.hpp"
#include "detail/vec.hpp"
#include "pectinate/errors.hpp"

namespace pectinate {
namespace {

using detail::Vector;
using detail::vector;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
/// Fins and splinters that repairs cut off are not worth a refusal.
constexpr double greatest_fragment_share = 0.01;

std::int32_t largest_component(const SurfaceMesh& mesh) {
  const auto& components = mesh.components();
  const auto largest = std::max_element(components.begin(), components.end(),
                                        [](const auto& a, const auto& b) { return a.area < b.area; });
  if (mesh.area() - largest->area > greatest_fragment_share * mesh.area()) {
    throw InvalidMesh("the surface has " + std::to_string(components.size()) +
                      " components and no single one with 99 % of its area; map each on its own");
  }
  return static_cast<std::int32_t>(largest - components.begin());
}

void check_is_holed_sphere(const SurfaceComponent& component) {
  if (!component.orientable) {
    throw InvalidMesh("the surface is not orientable (a Moebius strip is in it), so it has no map onto a disk");
  }
  if (component.genus != 0) {
    throw InvalidMesh("the surface has " + std::to_string(component.genus) +
                      " handle(s), so it has no map onto a disk; cut them open");
  }
  if (component.boundary_loop_count == 0) {
    throw InvalidMesh("the surface is closed, so it has no map onto a disk; cut an opening, such as the valve");
  }
}

std::int32_t choose_outer_loop(const SurfaceMesh& mesh, std::int32_t component, std::optional<std::int32_t> given) {
  const auto& loops = mesh.boundary_loops();
  const auto is_on_component = [&](const BoundaryLoop& loop) { return loop.component == component; };
  if (!given)
    return static_cast<std::int32_t>(std::find_if(loops.begin(), loops.end(), is_on_component) - loops.begin());
  if (*given < 0 || *given >= static_cast<std::int32_t>(loops.size())) {
    throw InvalidOption("outer_loop is " + std::to_string(*given) + ", but the surface has boundary loops 0 to " +
                        std::to_string(loops.size() - 1));
  }
  if (!is_on_component(loops[*given])) {
    throw InvalidOption("outer_loop " + std::to_string(*given) +
                        " bounds a fragment of the surface; choose a loop of its main component");
  }
  return *given;
}

double ambiguity_of_longest(const SurfaceMesh& mesh, std::int32_t component) {
  std::vector<double> lengths;
  for (const auto& loop : mesh.boundary_loops()) {
    if (loop.component == component) lengths.push_back(loop.length);
  }
  return lengths.size() < 2 ? 0 : lengths[1] / lengths[0];
}

/// A triangle's sides from its first corner, on the surface and in the disk.
struct TriangleMap {
  Eigen::Matrix2d surface, disk;  ///< a side per column
};

TriangleMap triangle_map(const SurfaceMesh& mesh, const std::vector<DiskPoint>& points, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles()[t];
  const Vector ab = vector(mesh.vertices()[b]) - vector(mesh.vertices()[a]);
  const Vector ac = vector(mesh.vertices()[c]) - vector(mesh.vertices()[a]);
  const Vector along = ab.normalized();
  TriangleMap map;
  map.surface << ab.norm(), ac.dot(along), 0, 2 * mesh.triangle_areas()[t] / ab.norm();
  map.disk << points[b][0] - points[a][0], points[c][0] - points[a][0],  //
      points[b][1] - points[a][1], points[c][1] - points[a][1];
  return map;
}

/// Greater over smaller singular value.
double anisotropy(const Eigen::Matrix2d& m) {
  const double greater = (std::hypot(m(0, 0) + m(1, 1), m(1, 0) - m(0, 1)) +  //
                          std::hypot(m(0, 0) - m(1, 1), m(1, 0) + m(0, 1))) /
                         2;
  const double determinant = std::abs(m.determinant());
  if (determinant == 0) return std::numeric_limits<double>::infinity();
  return std::max(1.0, greater / determinant * greater);
}

/// Of the component's triangles; NaN elsewhere.
std::vector<TriangleDistortion> measure_distortion(const SurfaceMesh& mesh, std::int32_t component,
                                                   const std::vector<DiskPoint>& points) {
  std::vector<TriangleDistortion> distortion(mesh.triangle_count(), {nan, nan});
  double disk_area = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (mesh.triangle_components()[t] != component) continue;
    const auto [surface, disk] = triangle_map(mesh, points, t);
    const double area = disk.determinant() / 2;
    disk_area += area;
    distortion[t] = {area / mesh.triangle_areas()[t], anisotropy(disk * surface.inverse())};
  }
  const double density = disk_area / mesh.components()[component].area;
  for (auto& triangle : distortion) triangle.area_ratio /= density;
  return distortion;
}

std::vector<std::int32_t> flipped_triangles(const std::vector<TriangleDistortion>& distortion) {
  std::vector<std::int32_t> flipped;
  for (std::size_t t = 0; t < distortion.size(); ++t) {
    if (distortion[t].area_ratio <= 0) flipped.push_back(static_cast<std::int32_t>(t));
  }
  return flipped;
}

}  // namespace

bool has_parameterization() {
  return detail::has_mean_value_map();
}

Parameterization parameterize(const SurfaceMesh& mesh, const ParameterizationOptions& options) {
  const std::int32_t component = largest_component(mesh);
  check_is_holed_sphere(mesh.components()[component]);
  const std::int32_t outer_loop = choose_outer_loop(mesh, component, options.outer_loop);
  const auto& loops = mesh.boundary_loops();
  const auto filled = detail::fill_holes(mesh, outer_loop);

  std::vector<Vec3> centroids;
  centroids.reserve(loops.size());
  for (const auto& loop : loops) centroids.push_back(loop.centroid);
  std::vector<std::int32_t> border = loops[outer_loop].vertices;
  for (auto& v : border) v = filled.filled_vertices[v];
  const auto images =
      detail::mean_value_map(detail::on_filled(filled, mesh.vertices(), centroids), filled.triangles, border);

  Parameterization result{{}, outer_loop, ambiguity_of_longest(mesh, component), {}, {}, {}};
  result.points.assign(mesh.vertices().size(), {nan, nan});
  for (std::size_t i = 0; i < filled.mesh_vertices.size(); ++i) result.points[filled.mesh_vertices[i]] = images[i];
  result.loop_centres.assign(loops.size(), {nan, nan});
  result.loop_centres[outer_loop] = {0, 0};
  for (std::size_t hole = 0; hole < filled.closed_loops.size(); ++hole) {
    result.loop_centres[filled.closed_loops[hole]] = images[filled.centre(hole)];
  }
  result.distortion = measure_distortion(mesh, component, result.points);
  result.flipped_triangles = flipped_triangles(result.distortion);
  return result;
}

}  // namespace pectinate
