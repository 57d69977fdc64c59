// SPDX-License-Identifier: MIT
#include "detail/closed_orbit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "detail/crossings.hpp"
#include "detail/self_free_run.hpp"

namespace pectinate::detail {
namespace {

/// A curve that comes back this near to where it was is closed; in chord coordinates.
constexpr double closing_tolerance = 1e-9;
/// Newton's method on a piecewise affine map needs few steps or none helps.
constexpr int most_corrections = 8;
/// How much farther a curve that came near itself is followed.
constexpr std::int64_t most_turns = 16;
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

  Chord chord() const {
    return {coordinate_, static_cast<float>(chord_length(here(), coordinate_)), 2 * triangle_ + (exit_ == low_high)};
  }
  double slope() const { return slope_; }

 private:
  const TriangleCrossings& here() const { return sheet_->crossings[triangle_]; }

  const Sheet* sheet_;
  std::int32_t triangle_;
  Role exit_;
  double coordinate_, slope_ = 1;
};

/// Coming back to the first triangle in the same sense.
struct Return {
  int count;           ///< how often it was come back to
  std::int64_t steps;  ///< triangles crossed since
  double coordinate, slope;
};

/// A closed curve through a chord, or how it comes back.
struct Round {
  Chords chords;  ///< empty if it is not closed
  std::optional<Return> result;
};

/// As far as the return with the same number as that expected.
Round go_round(const Sheet& sheet, const Chord& start, const Return& expected) {
  Round round;
  Walk walk(sheet, start);
  int count = 0;
  for (std::int64_t step = 1; step <= 2 * expected.steps; ++step) {
    round.chords.push_back(walk.chord());
    if (!walk.advance()) break;
    const auto chord = walk.chord();
    if (chord.code != start.code) continue;
    ++count;
    round.result = Return{count, step, chord.coordinate, walk.slope()};
    if (std::abs(chord.coordinate - start.coordinate) <= closing_tolerance) return round;
    if (count == expected.count) break;
  }
  round.chords.clear();
  if (count != expected.count) round.result.reset();
  return round;
}

/// The closed curve near a chord that comes back, if there is one.
Chords converge(const Sheet& sheet, Chord start, Return last) {
  for (int i = 0; i < most_corrections; ++i) {
    const double shift = last.coordinate - start.coordinate;
    if (std::abs(shift) > closing_tolerance) start.coordinate += shift / (1 - last.slope);
    if (!(start.coordinate > least_position && start.coordinate < 1 - least_position)) return {};
    auto round = go_round(sheet, start, last);
    if (!round.chords.empty() || !round.result) return std::move(round.chords);
    last = *round.result;
  }
  return {};
}

}  // namespace

std::vector<Chords> closed_orbits(const Sheet& sheet, const Chord& start, std::int64_t triangle_count) {
  std::vector<Chords> orbits;
  // As the curve gets nearer to the one that it ends on, it is compared with where it was later and later.
  Chord anchor = start;
  Walk walk(sheet, anchor);
  Return last{0, 0, 0, 0};
  for (std::int64_t step = 0, patience = 2 * triangle_count; step < most_turns * triangle_count; ++step) {
    if (!walk.advance()) break;
    ++last.steps;
    const auto chord = walk.chord();
    if (chord.code == anchor.code) {
      last = {last.count + 1, last.steps, chord.coordinate, walk.slope()};
      auto orbit = converge(sheet, anchor, last);
      const bool is_found = !orbit.empty();
      if (is_found && (orbits.empty() || orbit.size() != orbits.back().size())) orbits.push_back(std::move(orbit));
      if (is_found && (last.slope > 0 || last.count > 1)) break;
    } else if (last.steps >= patience && orbits.empty()) {
      anchor = chord;
      walk = Walk(sheet, anchor);
      last = {0, 0, 0, 0};
      patience *= 2;
    }
  }
  // What rounding leaves open is then least to be seen.
  for (auto& orbit : orbits) {
    const auto longest = std::ranges::max_element(orbit, {}, &Chord::length);
    std::rotate(orbit.begin(), longest + 1, orbit.end());
  }
  return orbits;
}

bool keeps_from_itself(const std::vector<Vector>& points, double distance) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) length += (points[i + 1] - points[i]).norm();
  return length >= least_length * distance && is_self_free_loop(points, distance, 2 * distance);
}

}  // namespace pectinate::detail
