// SPDX-License-Identifier: MIT
#include "detail/chord_tracer.hpp"

#include <algorithm>
#include <limits>

#include "detail/chord_sides.hpp"

namespace pectinate::detail {
namespace {

/// From so far on, in separation distances, of so many chords of a trajectory the end of one is kept.
constexpr double kept_from = 64;
constexpr std::int64_t kept_every = 32;

/// A trajectory is left off when of the last so many chords every eighth lies in a served triangle: others go there.
constexpr std::int64_t most_served = 256, looked_at_every = 8;

/// d_sep, if it is the same everywhere, or 0.
double common_separation(const TracingOptions& options) {
  const auto& varying = options.separation_distances;
  if (varying.empty()) return options.separation_distance;
  const auto [least, greatest] = std::ranges::minmax(varying);
  return least == greatest ? least : 0;
}

}  // namespace

ChordTracer::ChordTracer(const StreamlineTracer& tracer, const ChordOccupancy& occupancy, const LineRules& rules)
    : tracer_(tracer),
      occupancy_(occupancy),
      sheet_(tracer.sheet()),
      crossings_(sheet_.crossings),
      separation_(common_separation(tracer.options())),
      far_(rules.close_loops || separation_ == 0 ? std::numeric_limits<double>::infinity()
                                                 : std::max(kept_from * separation_, rules.minimum_length)) {}

std::array<StopReason, 2> ChordTracer::trace(const ChordPlace& start, const Obstacles& obstacles, Chords& chords) {
  const auto& crossings = crossings_[start.triangle];
  const Chord first = make_chord(sheet_, start, true);
  visited_.start(crossings_.size());
  visited_.revisit(start.triangle, start.coordinate, crossings.width, 0);
  has_passed_ = false;
  backwards_.clear();
  std::array<StopReason, 2> ends;
  ends[0] = walk(first, exit_role(crossings, low_high, start.coordinate), obstacles, backwards_);
  // Traced away from the start: turned round, each chord leaves through the side that it was entered through.
  for (auto chord = backwards_.rbegin(); chord != backwards_.rend(); ++chord) {
    chords.push_back({chord->coordinate, chord->length, chord->code ^ 1});
  }
  chords.push_back(first);
  ends[1] = walk(first, low_high, obstacles, chords);
  return ends;
}

/// Appends the chords that follow on one, leaving through a side.
StopReason ChordTracer::walk(const Chord& start, Role exit, const Obstacles& obstacles, Chords& chords) {
  const auto* const all = crossings_.data();
  const auto max_steps = tracer_.options().max_steps;
  const auto* crossings = &all[start.triangle()];
  double coordinate = start.coordinate;
  double arc = 0;
  std::int64_t served = 0;  // the last so many chords
  for (std::int64_t step = 0; step < max_steps; ++step) {
    const auto way_out = crossings->exit(exit);
    const auto triangle = way_out.triangle;
    if (triangle < 0) return way_out.stop_reason;
    const double position = edge_position(*crossings, exit, coordinate);
    crossings = &all[triangle];
    // It goes on into one of two triangles; by the time it is known which, both will be at hand.
    if (way_out.role == low_high) {
      prefetch(crossings->neighbours[low_middle], obstacles.others);
      prefetch(crossings->neighbours[middle_high], obstacles.others);
    } else {
      prefetch(crossings->neighbours[low_high], obstacles.others);
    }
    coordinate = chord_coordinate(*crossings, way_out.role, position);
    if (obstacles.others && occupancy_.stopped().contains(triangle, coordinate)) {
      return occupancy_.stop_reason(triangle, coordinate);
    }
    if (visited_.revisit(triangle, coordinate, crossings->width, separation(triangle))) {
      return StopReason::near_itself;
    }
    exit = exit_role(*crossings, way_out.role, coordinate);
    chords.push_back(make_chord(sheet_, {triangle, coordinate}, exit == low_high));
    arc += chords.back().length;
    if (obstacles.served != nullptr && step % looked_at_every == 0) {
      served = obstacles.served->has(triangle) ? served + looked_at_every : 0;
      if (served > most_served) return left_off;
    }
    if (arc < far_ || step % kept_every != 0) continue;
    if (comes_back(chords.back(), &chords == &backwards_ ? -arc : arc)) return StopReason::near_itself;
  }
  return StopReason::max_steps;
}

/// Keeps the end of a chord, so far from the start; is it near another that was kept?
bool ChordTracer::comes_back(const Chord& chord, double arc) {
  const Vector point = point_on(sheet_, chord, exit_side(sheet_, chord));
  if (!has_passed_) passed_.start(separation_, point);
  has_passed_ = true;
  const bool is_near = passed_.is_near(point, arc);
  passed_.add(point, arc);
  return is_near;
}

}  // namespace pectinate::detail
