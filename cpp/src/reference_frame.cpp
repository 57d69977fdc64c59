// SPDX-License-Identifier: MIT
#include "pectinate/reference_frame.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "detail/critical_points.hpp"
#include "detail/dirichlet_solver.hpp"
#include "detail/field_of_directions.hpp"
#include "detail/fit_checks.hpp"
#include "detail/hole_filling.hpp"
#include "detail/mean_value.hpp"
#include "detail/vec.hpp"
#include "pectinate/errors.hpp"

namespace pectinate {
namespace {

using detail::FilledSurface;
using detail::Vector;
using detail::vector;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
/// Values in [0, 1] that differ by less are equal but for rounding.
constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();

/// A function on the filled disk.
struct DiskFunction {
  std::vector<double> values;
  std::vector<bool> imposed;  ///< where the value was given
};

void check_fits(const SurfaceMesh& mesh, const Parameterization& parameterization) {
  if (detail::is_of(parameterization, mesh)) return;
  throw InvalidOption("the parameterization is not of this mesh: it has other vertices or boundary loops");
}

void check_inner_loop(const SurfaceMesh& mesh, std::int32_t inner, std::int32_t outer) {
  const auto& loops = mesh.boundary_loops();
  const auto name = "inner_loop " + std::to_string(inner);
  if (inner < 0 || inner >= static_cast<std::int32_t>(loops.size())) {
    throw InvalidOption(name + " does not exist; the surface has boundary loops 0 to " +
                        std::to_string(loops.size() - 1));
  }
  if (inner == outer) throw InvalidOption(name + " is the outer loop, where u = 1; choose another one");
  if (loops[inner].component != loops[outer].component) {
    throw InvalidOption(name + " bounds a fragment of the surface; choose a loop of its main component");
  }
}

std::vector<Vec3> disk_vertices(const FilledSurface& filled, const Parameterization& parameterization) {
  std::vector<Vec3> vertices;
  vertices.reserve(filled.vertex_count());
  for (const auto& [x, y] : detail::on_filled(filled, parameterization.points, parameterization.loop_centres)) {
    if (!std::isfinite(x) || !std::isfinite(y)) {
      throw InvalidOption("the parameterization is not of this mesh: a vertex has no place in the disk");
    }
    vertices.push_back({x, y, 0});
  }
  return vertices;
}

std::int32_t nearest_vertex(const SurfaceMesh& mesh, const FilledSurface& filled, const Vec3& point) {
  if (!vector(point).allFinite()) throw InvalidOption("inner_point is not finite");
  std::int32_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < filled.mesh_vertices.size(); ++i) {
    const double distance = (vector(mesh.vertices()[filled.mesh_vertices[i]]) - vector(point)).stableNorm();
    if (distance >= least) continue;
    least = distance;
    nearest = static_cast<std::int32_t>(i);
  }
  return nearest;
}

void impose(DiskFunction& function, std::int32_t vertex, double value) {
  function.values[vertex] = value;
  function.imposed[vertex] = true;
}

/// u = 1 on the outer loop and 0 on the inner one with its hole, or at the inner point; nothing elsewhere.
DiskFunction imposed_values(const SurfaceMesh& mesh, const FilledSurface& filled, std::int32_t outer_loop,
                            const ReferenceFrameOptions& options) {
  DiskFunction u{std::vector<double>(filled.vertex_count(), 0), std::vector<bool>(filled.vertex_count(), false)};
  for (const auto v : mesh.boundary_loops()[outer_loop].vertices) impose(u, filled.filled_vertices[v], 1);
  if (options.inner_loop) {
    const auto hole = std::find(filled.closed_loops.begin(), filled.closed_loops.end(), *options.inner_loop);
    impose(u, filled.centre(static_cast<std::size_t>(hole - filled.closed_loops.begin())), 0);
    for (const auto v : mesh.boundary_loops()[*options.inner_loop].vertices) impose(u, filled.filled_vertices[v], 0);
  }
  if (options.inner_point) {
    const auto nearest = nearest_vertex(mesh, filled, *options.inner_point);
    if (u.imposed[nearest])
      throw InvalidOption("inner_point is nearest to the outer loop, where u = 1; move it inwards");
    impose(u, nearest, 0);
  }
  return u;
}

/// Imposes u where an edge between two border vertices cuts a region off: it is constant there, which a solver would
/// return with noise.
DiskFunction with_constant_regions(DiskFunction u, const Eigen::SparseMatrix<double>& matrix) {
  std::vector<bool> visited = u.imposed;
  for (std::size_t start = 0; start < visited.size(); ++start) {
    if (visited[start]) continue;
    std::vector<std::int32_t> region{static_cast<std::int32_t>(start)};
    visited[start] = true;
    double least = 1, greatest = 0;
    for (std::size_t i = 0; i < region.size(); ++i) {
      for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, region[i]); entry; ++entry) {
        const auto neighbour = static_cast<std::int32_t>(entry.row());
        if (u.imposed[neighbour]) {
          least = std::min(least, u.values[neighbour]);
          greatest = std::max(greatest, u.values[neighbour]);
        } else if (!visited[neighbour]) {
          visited[neighbour] = true;
          region.push_back(neighbour);
        }
      }
    }
    if (least < greatest) continue;
    for (const auto v : region) impose(u, v, least);
  }
  return u;
}

/// Laplace's equation on the disk.
DiskFunction harmonic(const DiskFunction& imposed, const FilledSurface& filled, const std::vector<Vec3>& disk) {
  const auto matrix = detail::mean_value_matrix(disk, filled.triangles);
  DiskFunction u = with_constant_regions(imposed, matrix);
  const auto size = static_cast<Eigen::Index>(u.values.size());
  const Eigen::VectorXd given = Eigen::Map<const Eigen::VectorXd>(u.values.data(), size);
  const Eigen::VectorXd solution = detail::DirichletSolver(matrix, u.imposed).solve(given);
  for (Eigen::Index i = 0; i < size; ++i) u.values[i] = std::clamp(solution[i], 0.0, 1.0);
  return u;
}

/// (1 + x) / 2.
DiskFunction across_disk(DiskFunction u, const std::vector<Vec3>& disk) {
  for (std::size_t i = 0; i < disk.size(); ++i) u.values[i] = std::clamp((1 + disk[i][0]) / 2, 0.0, 1.0);
  return u;
}

/// A unit vector in every triangle that has one.
struct Directions {
  std::vector<Vec3> units;
  std::vector<bool> known;
};

/// The direction of the gradient; none where the function is constant or unknown.
Directions gradient_directions(const SurfaceMesh& mesh, const std::vector<double>& u) {
  Directions directions{std::vector<Vec3>(mesh.triangle_count()), std::vector<bool>(mesh.triangle_count(), false)};
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto& [a, b, c] = mesh.triangles()[t];
    const double rise_b = u[b] - u[a], rise_c = u[c] - u[a];
    if (!(std::max(std::abs(rise_b), std::abs(rise_c)) > rounding)) continue;
    const auto at = [&](std::int32_t v) { return vector(mesh.vertices()[v]); };
    const Vector along_contour = rise_b * (at(a) - at(c)) + rise_c * (at(b) - at(a));
    directions.units[t] = detail::vec3(vector(mesh.triangle_normals()[t]).cross(along_contour).normalized());
    directions.known[t] = true;
  }
  return directions;
}

Vector unit_side(const SurfaceMesh& mesh, std::int32_t t, int side) {
  const auto& corners = mesh.triangles()[t];
  return (vector(mesh.vertices()[corners[(side + 1) % 3]]) - vector(mesh.vertices()[corners[side]])).normalized();
}

/// A direction in a triangle, turned about a side into the plane of its neighbour there.
Vec3 turned_about_side(const SurfaceMesh& mesh, std::int32_t t, int side, const Vec3& direction) {
  const Vector along = unit_side(mesh, t, side);
  const auto left = [&](std::int32_t triangle) -> Vector {
    return vector(mesh.triangle_normals()[triangle]).cross(along);
  };
  const auto neighbour = mesh.neighbour(t, side).triangle;
  const auto v = vector(direction);
  return detail::vec3((v.dot(along) * along + v.dot(left(t)) * left(neighbour)).normalized());
}

/// Gives every triangle a direction: that of the nearest triangle that has one, by the number of sides between; on
/// components where none has, starting from the first side of the first triangle.
std::vector<Vec3> spread(const SurfaceMesh& mesh, Directions directions) {
  auto& [units, known] = directions;
  std::vector<std::int32_t> queue;
  queue.reserve(units.size());
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(units.size()); ++t) {
    if (known[t]) queue.push_back(t);
  }
  const auto add = [&](std::int32_t t, const Vec3& direction) {
    units[t] = direction;
    known[t] = true;
    queue.push_back(t);
  };
  std::int32_t next_start = 0;
  for (std::size_t i = 0; i < units.size(); ++i) {
    if (i == queue.size()) {
      while (known[next_start]) ++next_start;
      add(next_start, detail::vec3(unit_side(mesh, next_start, 0)));
    }
    const auto t = queue[i];
    for (int side = 0; side < 3; ++side) {
      const auto neighbour = mesh.neighbour(t, side).triangle;
      if (neighbour >= 0 && !known[neighbour]) add(neighbour, turned_about_side(mesh, t, side, units[t]));
    }
  }
  return std::move(units);
}

/// In mesh vertices; a hole's centre is none.
std::vector<CriticalPoint> critical_mesh_vertices(const FilledSurface& filled, const DiskFunction& u) {
  std::vector<CriticalPoint> critical;
  for (const auto& [vertex, index] : detail::critical_points(filled.triangles, u.values, u.imposed)) {
    if (vertex < filled.centre(0)) critical.push_back({filled.mesh_vertices[vertex], index});
  }
  return critical;
}

ReferenceFrame frame_of(const SurfaceMesh& mesh, const FilledSurface& filled, const DiskFunction& u) {
  ReferenceFrame frame;
  frame.u.assign(mesh.vertices().size(), nan);
  for (std::size_t i = 0; i < filled.mesh_vertices.size(); ++i) frame.u[filled.mesh_vertices[i]] = u.values[i];
  const auto gradients = gradient_directions(mesh, frame.u);
  frame.longitudinal = spread(mesh, gradients);
  frame.transverse.reserve(mesh.triangle_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Vector normal = vector(mesh.triangle_normals()[t]);
    frame.transverse.push_back(detail::vec3(normal.cross(vector(frame.longitudinal[t]))));
    if (!gradients.known[t]) frame.borrowed_triangles.push_back(static_cast<std::int32_t>(t));
  }
  frame.critical_points = critical_mesh_vertices(filled, u);
  return frame;
}

/// The angle of the line along (x, y), the same for (-x, -y), in (-pi/2, pi/2].
double line_angle(double x, double y) {
  const double angle = x < 0 ? std::atan2(-y, -x) : std::atan2(y, x);
  constexpr double quarter_turn = std::numbers::pi / 2;
  return angle <= -quarter_turn ? quarter_turn : angle;
}

void check_triangle_count(std::size_t given, std::size_t expected, const char* what) {
  if (given == expected) return;
  throw InvalidField(std::string(what) + " for " + std::to_string(given) + " triangles, but the frame has " +
                     std::to_string(expected) + "; both must be of one mesh");
}

}  // namespace

ReferenceFrame make_reference_frame(const SurfaceMesh& mesh, const Parameterization& parameterization,
                                    const ReferenceFrameOptions& options) {
  check_fits(mesh, parameterization);
  const auto outer_loop = parameterization.outer_loop;
  if (options.inner_loop && options.inner_point) {
    throw InvalidOption("inner_loop and inner_point are both given; u is 0 at one of them only");
  }
  if (options.inner_loop) check_inner_loop(mesh, *options.inner_loop, outer_loop);
  const auto filled = detail::fill_holes(mesh, outer_loop);
  const auto disk = disk_vertices(filled, parameterization);
  const auto imposed = imposed_values(mesh, filled, outer_loop, options);
  const bool has_inner = options.inner_loop || options.inner_point;
  return frame_of(mesh, filled, has_inner ? harmonic(imposed, filled, disk) : across_disk(imposed, disk));
}

std::vector<double> field_angles(const ReferenceFrame& frame, const OrientationField& field) {
  check_triangle_count(field.directions().size(), frame.longitudinal.size(), "the field is");
  std::vector<double> angles(frame.longitudinal.size(), nan);
  for (std::size_t t = 0; t < angles.size(); ++t) {
    if (!field.has_direction(static_cast<std::int32_t>(t))) continue;
    const auto direction = vector(field.directions()[t]);
    angles[t] = line_angle(direction.dot(vector(frame.longitudinal[t])), direction.dot(vector(frame.transverse[t])));
  }
  return angles;
}

OrientationField field_from_angles(const SurfaceMesh& mesh, const ReferenceFrame& frame,
                                   const std::vector<double>& angles) {
  check_triangle_count(frame.longitudinal.size(), mesh.triangle_count(), "the reference frame is");
  check_triangle_count(angles.size(), mesh.triangle_count(), "angles are given");
  std::vector<Vec3> directions(angles.size(), Vec3{0, 0, 0});
  for (std::size_t t = 0; t < angles.size(); ++t) {
    if (!std::isfinite(angles[t])) continue;
    directions[t] = detail::vec3(std::cos(angles[t]) * vector(frame.longitudinal[t]) +
                                 std::sin(angles[t]) * vector(frame.transverse[t]));
  }
  return detail::field_of_directions(mesh, directions);
}

}  // namespace pectinate
