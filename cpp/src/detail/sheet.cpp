// SPDX-License-Identifier: MIT
#include "detail/sheet.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "detail/curve_order.hpp"

namespace pectinate::detail {
namespace {

/// An orientation this close to a side, in radians, is turned away from it: the infinitesimal change of section 2.4.
constexpr double least_angle_to_side = 1e-9;
/// Below this an angle has no sign: parallel orientations turn the same way on a rotated mesh.
constexpr double rounding = 1e-12;
/// Keeps chords apart from sides in triangles so thin that no orientation is away from all of them.
constexpr double least_split = 1e-12;

/// How a triangle's orientation stands to its sides: their parts across it and along it.
struct Sides {
  std::array<double, 3> across, along;
};

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<double, 3> no_angles = {not_a_number, not_a_number, not_a_number};

/// The same, kept until the neighbours are known as well.
struct SideAngles {
  /// The angle from a side's edge to the orientation, taken as running into the triangle, lies in (0, pi): `sine` and
  /// `cosine` are its, times the side's length; not numbers without an orientation.
  std::array<double, 3> sine, cosine;  ///< by Role
};

/// An orientation turned in its plane away from a side that it is parallel to.
Vector turned_away(const Vector& direction, const Vector& side, const Vector& normal) {
  const double angle = side.cross(direction).dot(normal) * side.dot(direction) / side.squaredNorm();
  const double turn = (angle < -rounding ? -least_angle_to_side : least_angle_to_side) - angle;
  return (direction + turn * normal.cross(direction)).normalized();
}

/// The corner between the others across the orientation: there the two sides beside it turn the same way.
int corner_between(const std::array<double, 3>& rise) {
  const bool first = rise[0] <= 0, second = rise[1] <= 0, third = rise[2] <= 0;
  if (third == first) return 0;
  return first == second ? 1 : 2;
}

/// A triangle's place and orientation.
struct Face {
  std::array<Vector, 3> corners;
  Vector normal, direction;
};

/// Measures the chords of one triangle; fills all but what lies beyond its sides.
Sides measure_chords(const Face& face, TriangleCrossings& crossings) {
  const auto& [a, b, c] = face.corners;
  const std::array<Vector, 3> sides = {b - a, c - b, a - c};
  std::array<double, 3> rise, run;
  const auto measure = [&](const Vector& along) {
    const Vector across = face.normal.cross(along);
    for (int k = 0; k < 3; ++k) {
      rise[k] = sides[k].dot(across);
      run[k] = sides[k].dot(along);
    }
  };
  Vector along = face.direction;
  measure(along);
  for (int k = 0; k < 3; ++k) {
    if (std::abs(rise[k]) >= least_angle_to_side * std::abs(run[k])) continue;
    along = turned_away(along, sides[k], face.normal);
    measure(along);
  }
  const int m = corner_between(rise);
  const int opposite = (m + 1) % 3;
  crossings.middle = static_cast<std::uint8_t>(m);
  crossings.split = std::clamp(-rise[m] / rise[opposite], least_split, 1 - least_split);
  crossings.longest_chord = static_cast<float>(std::abs(run[m] + crossings.split * run[opposite]));
  crossings.width = static_cast<float>(std::abs(rise[opposite]));
  return {rise, run};
}

/// Makes a sheet triangle by triangle.
class SheetMaker {
 public:
  SheetMaker(const SurfaceMesh& mesh, const OrientationField& field, double abrupt_turn_angle)
      : mesh_(mesh),
        field_(field),
        // pi disables the criterion, whatever the rounding.
        least_turn_cosine_(abrupt_turn_angle < std::numbers::pi ? std::cos(abrupt_turn_angle) : -2),
        vertex_ranks_(curve_ranks(mesh.vertices())),
        angles_(mesh.triangle_count()) {}

  Sheet make() && {
    sheet_.vertices.resize(mesh_.vertices().size());
    for (std::size_t v = 0; v < vertex_ranks_.size(); ++v) {
      sheet_.vertices[vertex_ranks_[v]] = vector(mesh_.vertices()[v]);
    }
    const auto count = static_cast<std::int32_t>(mesh_.triangle_count());
    sheet_.ranks = ranks_by_corner(mesh_.triangles(), vertex_ranks_);
    sheet_.mesh_triangles.resize(count);
    sheet_.corners.resize(count);
    sheet_.crossings.resize(count);
    for (std::int32_t t = 0; t < count; ++t) {
      if (t + measured_ahead < count) prefetch(sheet_.ranks[t + measured_ahead]);
      measure(t, sheet_.ranks[t]);
    }
    for (std::int32_t i = 0; i < count; ++i) {
      for (const auto role : {low_high, low_middle, middle_high}) set_exit(i, role);
    }
    return std::move(sheet_);
  }

 private:
  static constexpr std::int32_t measured_ahead = 8;

  /// What will soon be written lies scattered.
  void prefetch(std::int32_t i) const {
    __builtin_prefetch(&sheet_.mesh_triangles[i], 1);
    __builtin_prefetch(&sheet_.corners[i], 1);
    __builtin_prefetch(&sheet_.crossings[i], 1);
    __builtin_prefetch(&angles_[i], 1);
  }

  void measure(std::int32_t t, std::int32_t i) {
    sheet_.mesh_triangles[i] = t;
    const auto& corners = mesh_.triangles()[t];
    auto& crossings = sheet_.crossings[i];  // in place: to copy what was just written piece by piece makes it wait
    crossings = {};
    Sides sides{no_angles, no_angles};
    if (field_.has_direction(t)) {
      const auto at = [&](int k) { return vector(mesh_.vertices()[corners[k]]); };
      sides = measure_chords(
          {{at(0), at(1), at(2)}, vector(mesh_.triangle_normals()[t]), vector(field_.directions()[t])}, crossings);
    }
    const int m = crossings.middle;
    sheet_.corners[i] = {vertex_ranks_[corners[(m + 1) % 3]], vertex_ranks_[corners[m]],
                         vertex_ranks_[corners[(m + 2) % 3]]};
    auto& angles = angles_[i];
    for (int k = 0; k < 3; ++k) {
      const auto& across = mesh_.neighbour(t, k);
      const auto role = role_of(k, m);
      const bool runs_along = mesh_.runs_along(t, k);
      // Inside is to the left of a side; the orientation runs there if the side falls across it.
      angles.sine[role] = std::abs(sides.across[k]);
      angles.cosine[role] = (sides.across[k] < 0) == runs_along ? sides.along[k] : -sides.along[k];
      crossings.neighbours[role] = across.triangle < 0 ? -1 : sheet_.ranks[across.triangle];
      // The side there will be replaced by its role. Chord coordinates run low to high, sides run middle-low, low-high,
      // high-middle.
      const auto side_there = static_cast<Role>(std::max<std::int8_t>(across.side, 0));
      crossings.codes[role] = TriangleCrossings::make_code(side_there, runs_along != (role == low_high), 0);
    }
  }

  /// Notes what lies beyond a side.
  void set_exit(std::int32_t i, Role role) {
    auto& crossings = sheet_.crossings[i];
    const auto j = crossings.neighbours[role];
    const bool is_reversed = crossings.is_reversed(role);
    if (j < 0) {
      crossings.codes[role] = TriangleCrossings::make_code(low_high, is_reversed, stop(StopReason::boundary));
      return;
    }
    const Role role_there = role_of(crossings.codes[role] & 3, sheet_.crossings[j].middle);
    const auto &here = angles_[i], &there = angles_[j];
    const double sine = here.sine[role], cosine = here.cosine[role];
    // Unfolded about the edge, a straight way leaves at the angle here and goes on at pi minus it: the turn is the
    // difference of that and the angle there.
    const double turn_cosine = sine * there.sine[role_there] - cosine * there.cosine[role_there];
    const bool goes_on = turn_cosine >= least_turn_cosine_ * (sine * sine + cosine * cosine);
    crossings.codes[role] = TriangleCrossings::make_code(role_there, is_reversed, goes_on ? 0 : why_stop(i, j));
  }

  /// Why streamlines stop between two triangles (criterion 4, or where the field ends).
  int why_stop(std::int32_t i, std::int32_t j) const {
    const bool has_field = sheet_.has_direction(i) && sheet_.has_direction(j);
    return stop(has_field ? StopReason::abrupt_turn : StopReason::no_field);
  }

  static int stop(StopReason reason) { return static_cast<int>(reason) + 1; }

  const SurfaceMesh& mesh_;
  const OrientationField& field_;
  double least_turn_cosine_;
  std::vector<std::int32_t> vertex_ranks_;
  LargeArray<SideAngles> angles_;
  Sheet sheet_;
};

}  // namespace

Sheet make_sheet(const SurfaceMesh& mesh, const OrientationField& field, double abrupt_turn_angle) {
  return SheetMaker(mesh, field, abrupt_turn_angle).make();
}

}  // namespace pectinate::detail
