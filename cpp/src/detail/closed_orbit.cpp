// SPDX-License-Identifier: MIT
#include "detail/closed_orbit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

#include "detail/chord_sides.hpp"
#include "detail/crossings.hpp"
#include "detail/self_free_run.hpp"

namespace pectinate::detail {
namespace {

/// A curve that comes back this near to where it was is closed; in lengths of it. Where the field runs along the sides
/// of triangles, orientations are turned away from them by half as much.
constexpr double closing_tolerance = 2e-9;
/// Newton's method on a piecewise affine map needs few steps or none helps.
constexpr int most_corrections = 8;
/// A curve that came near itself is followed so many times as far.
constexpr std::int64_t walk_length = 4;
/// Of the returns on the way so many are tried, each nearer to its fixed point than those before.
constexpr int most_attempts = 16;
/// Chords of a triangle that near may be one, whatever their fixed point.
constexpr double close_coordinates = 1e-6;
/// In separation distances: up to this length no two points are more than twice that apart along a closed line, and
/// nothing would keep its sides from each other.
constexpr double least_length = 4;

double extent(const TriangleCrossings& crossings, Role role) {
  if (role == low_high) return 1;
  return role == low_middle ? crossings.split : 1 - crossings.split;
}

/// Goes from triangle to triangle; knows how the coordinate depends on that of the first chord.
class Walk {
 public:
  Walk(const Sheet& sheet, const Chord& start)
      : sheet_(&sheet), triangle_(start.triangle()), coordinate_(start.coordinate) {
    exit_ = start.leaves_through_low_high() ? low_high : exit_role(here(), low_high, coordinate_);
  }

  /// False where streamlines stop.
  bool advance() {
    const auto way_out = here().exit(exit_);
    if (way_out.triangle < 0) return false;
    const double position = edge_position(here(), exit_, coordinate_);
    const bool turns_round = here().is_reversed(exit_) != sheet_->crossings[way_out.triangle].is_reversed(way_out.role);
    slope_ /= turns_round ? -extent(here(), exit_) : extent(here(), exit_);
    triangle_ = way_out.triangle;
    coordinate_ = chord_coordinate(here(), way_out.role, position);
    slope_ *= extent(here(), way_out.role);
    exit_ = exit_role(here(), way_out.role, coordinate_);
    return true;
  }

  Chord chord() const { return make_chord(*sheet_, {triangle_, coordinate_}, exit_ == low_high); }
  double slope() const { return slope_; }

 private:
  const TriangleCrossings& here() const { return sheet_->crossings[triangle_]; }

  const Sheet* sheet_;
  std::int32_t triangle_;
  Role exit_;
  double coordinate_, slope_ = 1;
};

/// Coming back to a triangle in the same sense.
struct Return {
  Chord from;
  std::int64_t steps;  ///< triangles crossed in between
  double coordinate;
  double slope;  ///< by how much it changes with the coordinate there

  /// Where a curve along the same strip would close, as a coordinate of the triangle or beyond it.
  double fixed_point() const { return from.coordinate + (coordinate - from.coordinate) / (1 - slope); }
};

bool is_inside(double coordinate) {
  return coordinate > least_position && coordinate < 1 - least_position;
}

/// A closed curve through a chord, or else how it comes back.
struct Round {
  Chords chords;  ///< empty if it is not closed
  std::optional<Return> result;
};

Round go_round(const Sheet& sheet, const Chord& start, std::int64_t most_steps) {
  Round round;
  Walk walk(sheet, start);
  double length = 0;
  for (std::int64_t step = 1; step <= most_steps; ++step) {
    round.chords.push_back(walk.chord());
    length += round.chords.back().length;
    if (!walk.advance()) break;
    const auto chord = walk.chord();
    if (chord.code != start.code) continue;
    const double gap = std::abs(chord.coordinate - start.coordinate) * sheet.crossings[start.triangle()].width;
    if (gap <= closing_tolerance * length) return round;
    round.result = Return{start, step, chord.coordinate, walk.slope()};
    break;
  }
  round.chords.clear();
  return round;
}

/// The closed curve near a chord that comes back, if there is one.
Chords converge(const Sheet& sheet, const Return& first) {
  auto result = first;
  for (int i = 0; i < most_corrections; ++i) {
    auto start = result.from;
    if (i > 0) start.coordinate = result.fixed_point();
    if (!is_inside(start.coordinate)) break;
    auto round = go_round(sheet, start, 2 * first.steps);
    if (!round.chords.empty() || !round.result) return std::move(round.chords);
    result = *round.result;
  }
  return {};
}

/// Lets a closed curve begin behind its longest chord: what rounding leaves open is then least to be seen.
Chords begun_anew(const Sheet& sheet, Chords orbit) {
  const auto longest = std::ranges::max_element(orbit, {}, &Chord::length) - orbit.begin();
  const auto start = orbit[(longest + 1) % std::ssize(orbit)];
  auto round = go_round(sheet, start, std::ssize(orbit));
  return round.chords.empty() ? std::move(orbit) : std::move(round.chords);
}

}  // namespace

Chords closed_orbit(const Sheet& sheet, const Chord& start, std::int64_t triangle_count) {
  struct Visit {
    Chord chord;
    double slope;
    std::int64_t step;
  };
  std::unordered_map<std::int32_t, Visit> visits;
  Walk walk(sheet, start);
  double least_way = std::numeric_limits<double>::infinity();
  for (std::int64_t step = 0, attempts = 0; step < walk_length * triangle_count && attempts < most_attempts; ++step) {
    const auto chord = walk.chord();
    const auto [place, is_new] = visits.try_emplace(chord.code, Visit{chord, walk.slope(), step});
    if (!is_new) {
      const auto [from, slope, since] = std::exchange(place->second, {chord, walk.slope(), step});
      const Return back{from, step - since, chord.coordinate, walk.slope() / slope};
      const double goal = back.fixed_point();
      const double way = std::abs(goal - from.coordinate) * sheet.crossings[from.triangle()].width;
      const bool is_close = std::abs(back.coordinate - from.coordinate) < close_coordinates;
      if ((is_inside(goal) && way < least_way) || is_close) {
        auto orbit = converge(sheet, back);
        if (!orbit.empty()) return begun_anew(sheet, std::move(orbit));
        least_way = std::min(way, least_way);
        ++attempts;
      }
    }
    if (!walk.advance()) break;
  }
  return {};
}

bool keeps_from_itself(const std::vector<Vector>& points, double distance) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) length += (points[i + 1] - points[i]).norm();
  return length >= least_length * distance && is_self_free_loop(points, distance, 2 * distance);
}

}  // namespace pectinate::detail
