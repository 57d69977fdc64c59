// SPDX-License-Identifier: MIT
#include "detail/candidate_tracer.hpp"

#include <algorithm>

#include "detail/closed_orbit.hpp"

namespace pectinate::detail {

CandidateTracer::CandidateTracer(const StreamlineTracer& tracer, const ChordOccupancy& occupancy,
                                 const LineRules& rules, Candidates& candidates)
    : sheet_(tracer.sheet()),
      occupancy_(occupancy),
      close_loops_(rules.close_loops),
      chord_tracer_(tracer, occupancy, rules),
      candidates_(candidates) {}

Trajectory CandidateTracer::add(const ChordPlace& start, const ChordTracer::Obstacles& obstacles, bool hugs) {
  auto& chords = candidates_.chords();
  const auto first = std::ssize(chords);
  const auto ends = chord_tracer_.trace(start, {obstacles.others, close_loops_ ? nullptr : obstacles.served}, chords);
  const Trajectory trajectory({first, std::ssize(chords)}, ends, hugs);
  candidates_.add(trajectory);
  if (close_loops_) add_closed(trajectory);
  return trajectory;
}

/// Stores the closed curves that a trajectory winds onto.
void CandidateTracer::add_closed(const Trajectory& trajectory) {
  const auto& chords = candidates_.chords();
  const auto [first, last] = trajectory.stretch();
  Chord starts[] = {chords[first], chords[last - 1]};
  starts[0].code ^= 1;  // backwards
  for (const int end : {0, 1}) {
    if (trajectory.ends[end] != StopReason::near_itself) continue;
    add_closed(closed_orbit(sheet_, starts[end], last - first), trajectory.hugs);
  }
}

/// Stores a closed curve, if it is free and not too near itself.
void CandidateTracer::add_closed(const Chords& orbit, bool hugs) {
  const auto is_stopped = [&](const Chord& chord) {
    return occupancy_.stopped().contains(chord.triangle(), chord.coordinate);
  };
  if (orbit.empty() || std::ranges::any_of(orbit, is_stopped)) return;
  Polyline polyline;
  polyline.follow(sheet_, orbit, false);
  double distance = 0;
  for (const auto& chord : orbit) distance = std::max(distance, separation(chord.triangle()));
  if (!keeps_from_itself(polyline.points, distance)) return;
  auto& chords = candidates_.chords();
  const auto first = std::ssize(chords);
  chords.insert(chords.end(), orbit.begin(), orbit.end());
  candidates_.add({{first, std::ssize(chords)}, {StopReason::closed, StopReason::closed}, hugs});
}

}  // namespace pectinate::detail
