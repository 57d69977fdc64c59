// SPDX-License-Identifier: MIT
#include "detail/crossings.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "detail/edge_point.hpp"
#include "detail/vec.hpp"

namespace pectinate::detail {
namespace {

/// An orientation this close to a side, in radians, is turned away from it: the infinitesimal change of section 2.4.
constexpr double least_angle_to_side = 1e-7;
/// Below this an angle has no sign: parallel orientations turn the same way on a rotated mesh.
constexpr double rounding = 1e-12;
/// Keeps chords apart from sides in triangles so thin that no orientation is away from all of them.
constexpr double least_split = 1e-12;

Vector corner(const SurfaceMesh& mesh, std::int32_t t, int k) {
  return vector(mesh.vertices()[mesh.triangles()[t][k % 3]]);
}

/// The triangle's orientation, turned in its plane where it is parallel to a side.
Vector safe_direction(const SurfaceMesh& mesh, std::int32_t t, const Vector& direction) {
  const Vector normal = vector(mesh.triangle_normals()[t]);
  for (int k = 0; k < 3; ++k) {
    const Vector side = (corner(mesh, t, k + 1) - corner(mesh, t, k)).normalized();
    const double sine = side.cross(direction).dot(normal);
    if (std::abs(sine) >= least_angle_to_side) continue;
    const double angle = sine * side.dot(direction);
    const double turn = (angle < -rounding ? -least_angle_to_side : least_angle_to_side) - angle;
    return (direction + turn * normal.cross(direction)).normalized();
  }
  return direction;
}

/// The corner between the others, seen along the direction.
int middle_corner(const std::array<double, 3>& across) {
  for (int k = 0; k < 2; ++k) {
    const double one = across[(k + 1) % 3] - across[k], other = across[(k + 2) % 3] - across[k];
    if ((one <= 0 && other >= 0) || (one >= 0 && other <= 0)) return k;
  }
  return 2;
}

/// Angle in [0, pi] between an edge, from its first end to its second, and the orientation in one of its triangles,
/// taken as running from the edge into the triangle.
double angle_from_edge(const SurfaceMesh& mesh, const Vector& direction, std::int32_t t, int side) {
  const auto [a, b] = mesh.edges()[mesh.triangle_edges()[t][side]];
  const Vector edge = (vector(mesh.vertices()[b]) - vector(mesh.vertices()[a])).normalized();
  const Vector to_apex = corner(mesh, t, side + 2) - corner(mesh, t, side);
  const Vector inward = (to_apex - to_apex.dot(edge) * edge).normalized();
  const double sine = direction.dot(inward), cosine = direction.dot(edge);
  return sine < 0 ? std::atan2(-sine, -cosine) : std::atan2(sine, cosine);
}

struct Orientations {
  const SurfaceMesh& mesh;
  const OrientationField& field;
  std::vector<Vector> directions;  // safe ones
  std::vector<std::int8_t> middle;
};

TriangleCrossings measure_chords(const SurfaceMesh& mesh, std::int32_t t, const Vector& direction, int middle) {
  const Vector low = corner(mesh, t, middle + 1), high = corner(mesh, t, middle + 2), mid = corner(mesh, t, middle);
  const Vector across = vector(mesh.triangle_normals()[t]).cross(direction);
  const double width = (high - low).dot(across);
  const double split = std::clamp((mid - low).dot(across) / width, least_split, 1 - least_split);
  return {split, (low + split * (high - low) - mid).norm(), std::abs(width), {}};
}

/// The exit through a side; streamlines stop at borders, abrupt turns (criterion 4) and where the field ends.
Exit make_exit(const Orientations& all, std::int32_t t, int side, double abrupt_turn_angle) {
  const auto across = all.mesh.neighbour(t, side);
  const Role role = role_of(side, all.middle[t]);
  // Chord coordinates run low to high, sides run middle-low, low-high, high-middle.
  const bool reversed = all.mesh.runs_along(t, side) != (role == low_high);
  Exit exit{all.mesh.triangle_edges()[t][side], -1, low_high, StopReason::boundary, reversed};
  if (across.triangle < 0) return exit;
  exit.stop_reason = StopReason::no_field;
  if (!all.field.has_direction(across.triangle)) return exit;
  const double here = angle_from_edge(all.mesh, all.directions[t], t, side);
  const double there = angle_from_edge(all.mesh, all.directions[across.triangle], across.triangle, across.side);
  exit.stop_reason = StopReason::abrupt_turn;
  // Leaving at angle `here` + pi, entering at `there` on the other side of the edge: unfolded, the difference of
  // pi - here and there.
  if (std::abs(std::numbers::pi - here - there) > abrupt_turn_angle) return exit;
  exit.triangle = across.triangle;
  exit.role = role_of(across.side, all.middle[across.triangle]);
  return exit;
}

}  // namespace

std::vector<TriangleCrossings> make_crossings(const SurfaceMesh& mesh, const OrientationField& field,
                                              double abrupt_turn_angle) {
  const auto count = static_cast<std::int32_t>(mesh.triangle_count());
  Orientations all{mesh, field, std::vector<Vector>(count, Vector::Zero()), std::vector<std::int8_t>(count, 0)};
  std::vector<TriangleCrossings> crossings(count);
  for (std::int32_t t = 0; t < count; ++t) {
    if (!field.has_direction(t)) continue;
    all.directions[t] = safe_direction(mesh, t, vector(field.directions()[t]));
    const Vector across = vector(mesh.triangle_normals()[t]).cross(all.directions[t]);
    const Vector origin = corner(mesh, t, 0);
    all.middle[t] = static_cast<std::int8_t>(
        middle_corner({0, (corner(mesh, t, 1) - origin).dot(across), (corner(mesh, t, 2) - origin).dot(across)}));
    crossings[t] = measure_chords(mesh, t, all.directions[t], all.middle[t]);
  }
  for (std::int32_t t = 0; t < count; ++t) {
    if (!field.has_direction(t)) continue;
    for (int side = 0; side < 3; ++side) {
      crossings[t].exits[role_of(side, all.middle[t])] = make_exit(all, t, side, abrupt_turn_angle);
    }
  }
  return crossings;
}

double edge_position(const TriangleCrossings& crossings, Role role, double chord) {
  double along = chord;
  if (role == low_middle) along = chord / crossings.split;
  if (role == middle_high) along = (chord - crossings.split) / (1 - crossings.split);
  return clamp_position(crossings.exits[role].reversed ? 1 - along : along);
}

double chord_coordinate(const TriangleCrossings& crossings, Role role, double edge_position) {
  const double along = crossings.exits[role].reversed ? 1 - edge_position : edge_position;
  if (role == low_middle) return along * crossings.split;
  if (role == middle_high) return crossings.split + along * (1 - crossings.split);
  return along;
}

}  // namespace pectinate::detail
