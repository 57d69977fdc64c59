// SPDX-License-Identifier: MIT
#include "detail/boundary_demands.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "detail/mesh_geometry.hpp"

namespace pectinate::detail {
namespace {

/// A tangent as short as this beside unit ones, or an average of lines, has no direction.
constexpr double least_resultant = 1e-6;

/// Per side of a loop, its tangent: jagged borders turn fibres less than their edges do.
std::vector<Vector> smoothed_tangents(const SurfaceMesh& mesh, const BoundaryLoop& loop) {
  const std::size_t count = loop.vertices.size();
  const auto at = [&](std::size_t i) { return vector(mesh.vertices()[loop.vertices[i % count]]); };
  const auto unit_or = [](const Vector& sum, const Vector& otherwise) {
    const double length = sum.norm();
    return length > least_resultant ? Vector(sum / length) : otherwise;
  };
  std::vector<Vector> edges(count), corners(count), smooth(count), tangents(count);
  for (std::size_t i = 0; i < count; ++i) edges[i] = (at(i + 1) - at(i)).normalized();
  for (std::size_t i = 0; i < count; ++i) corners[i] = unit_or(edges[(i + count - 1) % count] + edges[i], edges[i]);
  for (std::size_t i = 0; i < count; ++i) {
    smooth[i] = unit_or(corners[(i + count - 1) % count] + 2 * corners[i] + corners[(i + 1) % count], corners[i]);
  }
  for (std::size_t i = 0; i < count; ++i) tangents[i] = unit_or(smooth[i] + smooth[(i + 1) % count], edges[i]);
  return tangents;
}

Vector side_direction(const SurfaceMesh& mesh, std::int32_t t, int side) {
  const auto at = corners(mesh, t);
  return at[(side + 1) % 3] - at[side];
}

/// A side of a loop and its tangent as a line in the plane of the side's triangle.
struct Side {
  std::int32_t number;
  Phase phase;
};

std::vector<Side> sides_by_triangle(const SurfaceMesh& mesh, const BoundaryLoop& loop, const LoopSides& numbers) {
  const auto tangents = smoothed_tangents(mesh, loop);
  std::vector<Side> sides;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::int32_t t = numbers[i] / 3;
    const Vector normal = vector(mesh.triangle_normals()[t]);
    const Vector flat = tangents[i] - tangents[i].dot(normal) * normal;
    const Vector along = flat.norm() > least_resultant ? flat : side_direction(mesh, t, numbers[i] % 3);
    sides.push_back({numbers[i], phase_of(along, triangle_frame(mesh, t))});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.number < b.number; });
  return sides;
}

}  // namespace

std::vector<LoopSides> find_loop_sides(const SurfaceMesh& mesh) {
  struct Position {
    std::size_t loop, index;
  };
  const auto& loops = mesh.boundary_loops();
  std::vector<Position> positions(mesh.vertices().size());
  std::vector<LoopSides> sides;
  for (std::size_t l = 0; l < loops.size(); ++l) {
    for (std::size_t i = 0; i < loops[l].vertices.size(); ++i) positions[loops[l].vertices[i]] = {l, i};
    sides.emplace_back(loops[l].vertices.size());
  }
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (mesh.neighbour(t, k).triangle >= 0) continue;
      const std::int32_t from = mesh.triangles()[t][k], to = mesh.triangles()[t][(k + 1) % 3];
      const auto [l, i] = positions[from];
      const auto& vertices = loops[l].vertices;
      const bool forwards = vertices[(i + 1) % vertices.size()] == to;
      sides[l][forwards ? i : positions[to].index] = 3 * t + k;
    }
  }
  return sides;
}

std::vector<Demand> boundary_demands(const SurfaceMesh& mesh, const BoundaryLoop& loop, const LoopSides& numbers,
                                     const BoundaryCondition& condition) {
  if (condition.rule == BoundaryRule::free) return {};
  const double sign = condition.rule == BoundaryRule::perpendicular ? -1 : 1;  // of exp(2 i angle)
  const auto sides = sides_by_triangle(mesh, loop, numbers);
  std::vector<Demand> demands;
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    const std::int32_t t = sides[first].number / 3;
    Phase sum = 0;
    int free_side = 0 + 1 + 2;
    for (; last < sides.size() && sides[last].number / 3 == t; ++last) {
      sum += sides[last].phase;
      free_side -= sides[last].number % 3;
    }
    if (last - first == 3) continue;
    // Two sides at right angles: the triangle's third side lies as the loop does.
    if (std::abs(sum) < least_resultant) sum = phase_of(side_direction(mesh, t, free_side), triangle_frame(mesh, t));
    demands.push_back({t, sign * sum / std::abs(sum), condition.weight, -1});
  }
  return demands;
}

}  // namespace pectinate::detail
