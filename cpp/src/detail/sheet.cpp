// SPDX-License-Identifier: MIT
#include "detail/sheet.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "detail/chord_measures.hpp"
#include "detail/curve_order.hpp"
#include "detail/scratch.hpp"

namespace pectinate::detail {
namespace {

/// Below this an angle has no sign: parallel orientations turn the same way on a rotated mesh.
constexpr double rounding = 1e-12;

/// Cosines of the angles, in (0, pi), from a triangle's edges to its orientation as it runs inwards there; by Role. Not
/// numbers without an orientation.
using SideCosines = std::array<double, 3>;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr SideCosines no_cosines = {not_a_number, not_a_number, not_a_number};

/// An orientation turned in its plane away from a side that it is parallel to.
Vector turned_away(const Vector& direction, const Vector& side, const Vector& normal) {
  const double angle = side.cross(direction).dot(normal) * side.dot(direction) / side.squaredNorm();
  const double turn = (angle < -rounding ? -least_angle_to_side : least_angle_to_side) - angle;
  return (direction + turn * normal.cross(direction)).normalized();
}

/// A triangle's orientation, turned away from all sides that it is parallel to.
Vec3 turned_away(const SurfaceMesh& mesh, std::int32_t triangle, const Vec3& direction) {
  const auto& corners = mesh.triangles()[triangle];
  const Vector normal = vector(mesh.triangle_normal(triangle));
  Vector along = vector(direction);
  for (int k = 0; k < 3; ++k) {
    const Vector side = vector(mesh.vertices()[corners[(k + 1) % 3]]) - vector(mesh.vertices()[corners[k]]);
    const Vector across = normal.cross(along);
    if (std::abs(side.dot(across)) >= least_angle_to_side * std::abs(side.dot(along))) continue;
    along = turned_away(along, side, normal);
  }
  return vec3(along);
}

/// Makes a sheet triangle by triangle.
class SheetMaker {
 public:
  SheetMaker(const SurfaceMesh& mesh, const OrientationField& field, double abrupt_turn_angle)
      : mesh_(mesh),
        field_(field),
        // pi disables the criterion, whatever the rounding.
        least_turn_cosine_(abrupt_turn_angle < std::numbers::pi ? std::cos(abrupt_turn_angle) : -2),
        scratch_(mesh.triangle_count() * sizeof(SideCosines)),
        vertex_ranks_(curve_ranks(mesh.vertices(), scratch_)) {}

  Sheet make() && {
    sheet_.vertices = large_array<Vector>(mesh_.vertices().size());
    for (std::size_t v = 0; v < vertex_ranks_.size(); ++v) {
      sheet_.vertices[vertex_ranks_[v]] = vector(mesh_.vertices()[v]);
    }
    const auto count = static_cast<std::int32_t>(mesh_.triangle_count());
    sheet_.ranks = ranks_by_corner(mesh_.triangles(), vertex_ranks_, scratch_);
    scratch_.next_step();
    cosines_ = scratch_.array<SideCosines>(count);
    sheet_.triangles = large_array<SheetTriangle>(count);
    sheet_.crossings = large_array<TriangleCrossings>(count);
    for (std::int32_t t = 0; t < count; t += measured_lanes) measure(t, std::min(count - t, measured_lanes));
    set_exits();
    sheet_.directed_area = directed_area();
    return std::move(sheet_);
  }

 private:
  static constexpr std::int32_t read_ahead = 16, written_ahead = 8;

  /// What will soon be read and written for some triangles on lies scattered.
  void prefetch(std::int32_t t) const {
    const auto last = static_cast<std::int32_t>(sheet_.ranks.size()) - 1;
    const auto read = std::min(t + read_ahead, last);
    for (int k = 0; k < 3; ++k) {
      const auto vertex = mesh_.triangles()[read][k];
      __builtin_prefetch(&mesh_.vertices()[vertex]);
      __builtin_prefetch(&vertex_ranks_[vertex]);
      __builtin_prefetch(&sheet_.ranks[std::max(mesh_.neighbour(read, k).triangle, 0)]);
    }
    const auto i = sheet_.ranks[std::min(t + written_ahead, last)];
    __builtin_prefetch(&sheet_.triangles[i], 1);
    __builtin_prefetch(&sheet_.crossings[i], 1);
    __builtin_prefetch(&cosines_[i], 1);
  }

  double directed_area() const {
    double area = 0;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh_.triangle_count()); ++t) {
      if (field_.has_direction(t)) area += mesh_.triangle_areas()[t];
    }
    return area;
  }

  /// Fewer than a full set of lanes are filled up with the last one.
  void measure(std::int32_t first, std::int32_t count) {
    Faces faces;
    for (std::int32_t lane = 0; lane < measured_lanes; ++lane) {
      const auto t = first + std::min(lane, count - 1);
      prefetch(t);
      const auto& corners = mesh_.triangles()[t];
      for (int k = 0; k < 3; ++k) faces.corners[k][lane] = &mesh_.vertices()[corners[k]];
      faces.directions[lane] = &field_.directions()[t];
    }
    auto measures = measure_chords(faces);
    if (measures.along_sides != 0) measures = measure_turned(first, count, faces, measures.along_sides);
    for (std::int32_t lane = 0; lane < count; ++lane) fill(first + lane, measures, lane);
  }

  ChordMeasures measure_turned(std::int32_t first, std::int32_t count, Faces faces, unsigned along_sides) const {
    std::array<Vec3, measured_lanes> turned;
    for (std::int32_t lane = 0; lane < count; ++lane) {
      if (!(along_sides >> lane & 1) || !field_.has_direction(first + lane)) continue;
      turned[lane] = turned_away(mesh_, first + lane, *faces.directions[lane]);
      faces.directions[lane] = &turned[lane];
    }
    return measure_chords(faces);
  }

  /// What is known of a side before its neighbour's records are there.
  struct Side {
    std::int32_t vertex;  // where it begins: the corner low, middle or high, by Role
    std::int32_t neighbour;
    std::uint8_t code;
    double cosine;
  };

  Side side_of_triangle(std::int32_t t, Role role, int middle, const ChordMeasures& measures, std::int32_t lane) const {
    static constexpr double signs[2] = {-1, 1};
    const int k = side_of(role, middle);
    const auto across = mesh_.neighbour(t, k);
    const unsigned runs_along = mesh_.sides_running_along(t) >> k & 1;
    // The side there will be replaced by its role. Chord coordinates run low to high, sides run middle-low, low-high,
    // high-middle.
    const auto side_there = static_cast<Role>(across.side & 3);
    return {vertex_ranks_[mesh_.triangles()[t][k]], across.triangle < 0 ? -1 : sheet_.ranks[across.triangle],
            TriangleCrossings::make_code(side_there, runs_along != (role == low_high), 0),
            measures.cosine[k][lane] * signs[runs_along]};
  }

  /// Fills a triangle's records, but for what its neighbours' must be known for. Nothing goes through small arrays: to
  /// read from them more at a time than was written would wait for all that was written before, which lies scattered.
  void fill(std::int32_t t, const ChordMeasures& measures, std::int32_t lane) {
    const bool has_direction = field_.has_direction(t);
    const int m = has_direction ? static_cast<int>(measures.middle[lane]) : 0;
    const auto i = sheet_.ranks[t];
    const Side low = side_of_triangle(t, low_high, m, measures, lane);
    const Side middle = side_of_triangle(t, low_middle, m, measures, lane);
    const Side high = side_of_triangle(t, middle_high, m, measures, lane);
    sheet_.triangles[i] = {low.vertex, middle.vertex, high.vertex, t};
    auto& crossings = sheet_.crossings[i];
    crossings.neighbours = {low.neighbour, middle.neighbour, high.neighbour};
    crossings.codes = {low.code, middle.code, high.code};
    crossings.middle = static_cast<std::uint8_t>(m);
    crossings.split = has_direction ? measures.split[lane] : 0;
    crossings.longest_chord = has_direction ? static_cast<float>(measures.longest_chord[lane]) : 0;
    crossings.width = has_direction ? static_cast<float>(measures.width[lane]) : 0;
    cosines_[i] = has_direction ? SideCosines{low.cosine, middle.cosine, high.cosine} : no_cosines;
  }

  /// Notes what lies beyond all sides.
  void set_exits() {
    auto* const all = sheet_.crossings.data();
    const auto* const cosines = cosines_.data();
    const auto count = sheet_.triangle_count();
    for (std::int32_t i = 0; i < count; ++i) {
      auto& crossings = all[i];
      for (const auto role : {low_high, low_middle, middle_high}) {
        const auto j = crossings.neighbours[role];
        const auto code = crossings.codes[role];
        if (j < 0) {
          crossings.codes[role] = TriangleCrossings::make_code(low_high, code & 4, stop(StopReason::boundary));
          continue;
        }
        const Role role_there = role_of(code & 3, all[j].middle);
        const double here = cosines[i][role], there = cosines[j][role_there];
        // Unfolded about the edge, a straight way leaves at the angle here and goes on at pi minus it: the turn is the
        // difference of that and the angle there.
        const double turn_cosine = std::sqrt((1 - here * here) * (1 - there * there)) - here * there;
        const bool goes_on = turn_cosine >= least_turn_cosine_;
        crossings.codes[role] =
            static_cast<std::uint8_t>((code & 4) | role_there | (goes_on ? 0 : why_stop(i, j) << 3));
      }
    }
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
  Scratch scratch_;
  std::vector<std::int32_t> vertex_ranks_;
  std::span<SideCosines> cosines_;
  Sheet sheet_;
};

}  // namespace

Sheet make_sheet(const SurfaceMesh& mesh, const OrientationField& field, double abrupt_turn_angle) {
  return SheetMaker(mesh, field, abrupt_turn_angle).make();
}

}  // namespace pectinate::detail
