// SPDX-License-Identifier: MIT
#include "detail/crossings.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "detail/edge_point.hpp"
#include "detail/vec.hpp"

namespace pectinate::detail {
namespace {

/// An orientation this close to a side, in radians, is turned away from it: the infinitesimal change of section 2.4.
constexpr double least_angle_to_side = 1e-9;
/// Below this an angle has no sign: parallel orientations turn the same way on a rotated mesh.
constexpr double rounding = 1e-12;
/// Keeps chords apart from sides in triangles so thin that no orientation is away from all of them.
constexpr double least_split = 1e-12;

/// How a triangle's orientation stands to its sides.
struct Sides {
  /// Of the angle, in (0, pi), from the edge of each side to the orientation, taken as running into the triangle.
  std::array<double, 3> cosine, sine;
};

/// An orientation turned in its plane away from a side that it is parallel to.
Vector turned_away(const Vector& direction, const Vector& side, const Vector& normal) {
  const double angle = side.cross(direction).dot(normal) * side.dot(direction) / side.squaredNorm();
  const double turn = (angle < -rounding ? -least_angle_to_side : least_angle_to_side) - angle;
  return (direction + turn * normal.cross(direction)).normalized();
}

/// The corner between the others across the orientation: there the two sides beside it turn the same way.
std::int32_t corner_between(const std::array<double, 3>& rise) {
  for (std::int32_t k = 0; k < 2; ++k) {
    if ((rise[(k + 2) % 3] <= 0) == (rise[k] <= 0)) return k;
  }
  return 2;
}

/// Measures the chords of one triangle; fills all but the exits.
Sides measure_chords(const SurfaceMesh& mesh, std::int32_t t, const Vector& direction, TriangleCrossings& crossings) {
  const auto& corners = mesh.triangles()[t];
  const auto at = [&](int k) { return vector(mesh.vertices()[corners[k % 3]]); };
  const Vector normal = vector(mesh.triangle_normals()[t]);
  const std::array<Vector, 3> sides = {at(1) - at(0), at(2) - at(1), at(0) - at(2)};
  std::array<double, 3> lengths, rise;
  Vector along = direction, across = normal.cross(along);
  const auto measure_rise = [&] {
    for (int k = 0; k < 3; ++k) rise[k] = sides[k].dot(across);
  };
  measure_rise();
  for (int k = 0; k < 3; ++k) {
    lengths[k] = mesh.edge_lengths()[mesh.triangle_edges()[t][k]];
    if (std::abs(rise[k]) >= least_angle_to_side * lengths[k]) continue;
    along = turned_away(along, sides[k], normal);
    across = normal.cross(along);
    measure_rise();
  }

  Sides result{};
  crossings.middle = corner_between(rise);
  for (int k = 0; k < 3; ++k) {
    // Inside is to the left of a side; the orientation runs there if the side falls across it.
    const double sign = (rise[k] < 0) == mesh.runs_along(t, k) ? 1 : -1;
    result.sine[k] = std::abs(rise[k]) / lengths[k];
    result.cosine[k] = sign * sides[k].dot(along) / lengths[k];
  }
  const int m = crossings.middle;
  const Vector& to_low = sides[m];
  const Vector& low_to_high = sides[(m + 1) % 3];
  crossings.split = std::clamp(-rise[m] / rise[(m + 1) % 3], least_split, 1 - least_split);
  crossings.longest_chord = (to_low + crossings.split * low_to_high).norm();
  crossings.width = std::abs(rise[(m + 1) % 3]);
  return result;
}

/// All triangles, measured.
struct Measured {
  const SurfaceMesh& mesh;
  const OrientationField& field;
  std::vector<Sides> sides;
  std::vector<TriangleCrossings> crossings;  // without exits
};

/// The exit through a side; streamlines stop at borders, abrupt turns (criterion 4) and where the field ends.
Exit make_exit(const Measured& all, std::int32_t t, int side, double least_turn_cosine) {
  const auto across = all.mesh.neighbour(t, side);
  const Role role = role_of(side, all.crossings[t].middle);
  // Chord coordinates run low to high, sides run middle-low, low-high, high-middle.
  const bool reversed = all.mesh.runs_along(t, side) != (role == low_high);
  Exit exit{all.mesh.triangle_edges()[t][side], -1, low_high, StopReason::boundary, reversed};
  if (across.triangle < 0) return exit;
  exit.stop_reason = StopReason::no_field;
  if (!all.field.has_direction(across.triangle)) return exit;
  const auto &here = all.sides[t], &there = all.sides[across.triangle];
  exit.stop_reason = StopReason::abrupt_turn;
  // Unfolded about the edge, a straight way leaves at angle `here` and goes on at pi - here: the turn is the
  // difference of that and `there`.
  const double turn_cosine = here.sine[side] * there.sine[across.side] - here.cosine[side] * there.cosine[across.side];
  if (turn_cosine < least_turn_cosine) return exit;
  exit.triangle = across.triangle;
  exit.role = role_of(across.side, all.crossings[across.triangle].middle);
  return exit;
}

}  // namespace

std::vector<TriangleCrossings> make_crossings(const SurfaceMesh& mesh, const OrientationField& field,
                                              double abrupt_turn_angle) {
  const auto count = static_cast<std::int32_t>(mesh.triangle_count());
  Measured all{mesh, field, std::vector<Sides>(count), std::vector<TriangleCrossings>(count)};
  for (std::int32_t t = 0; t < count; ++t) {
    if (!field.has_direction(t)) continue;
    all.sides[t] = measure_chords(mesh, t, vector(field.directions()[t]), all.crossings[t]);
  }
  // pi disables the criterion, whatever the rounding.
  const double least_turn_cosine = abrupt_turn_angle < std::numbers::pi ? std::cos(abrupt_turn_angle) : -2;
  for (std::int32_t t = 0; t < count; ++t) {
    if (!field.has_direction(t)) continue;
    for (int side = 0; side < 3; ++side) {
      all.crossings[t].exits[role_of(side, all.crossings[t].middle)] = make_exit(all, t, side, least_turn_cosine);
    }
  }
  return std::move(all.crossings);
}

}  // namespace pectinate::detail
