// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "detail/sheet.hpp"
#include "detail/trajectories.hpp"

namespace pectinate::detail {

inline Chord make_chord(const Sheet& sheet, const ChordPlace& place, bool leaves_through_low_high) {
  const auto length = static_cast<float>(chord_length(sheet.crossings[place.triangle], place.coordinate));
  return {place.coordinate, length, 2 * place.triangle + leaves_through_low_high};
}

/// The side other than low-high that a chord crosses.
inline Role short_side(const Sheet& sheet, const Chord& chord) {
  return exit_role(sheet.crossings[chord.triangle()], low_high, chord.coordinate);
}
inline Role exit_side(const Sheet& sheet, const Chord& chord) {
  return chord.leaves_through_low_high() ? low_high : short_side(sheet, chord);
}
inline Role entry_side(const Sheet& sheet, const Chord& chord) {
  return chord.leaves_through_low_high() ? short_side(sheet, chord) : low_high;
}

inline Vector point_on(const Sheet& sheet, const Chord& chord, Role side) {
  return sheet.point(chord.triangle(), side, chord.coordinate);
}

/// Weights of a mesh triangle's corners at a point so far along a side.
inline Vec3 weights_on_side(const TriangleCrossings& crossings, Role side, double along) {
  const int middle = crossings.middle, low = (middle + 1) % 3, high = (middle + 2) % 3;
  Vec3 weights{0, 0, 0};
  weights[side == middle_high ? middle : low] = 1 - along;
  weights[side == low_middle ? middle : high] = along;
  return weights;
}

/// The same in the chord's mesh triangle at its end on a side.
inline Vec3 weights_on_side(const Sheet& sheet, const Chord& chord, Role side) {
  const auto& crossings = sheet.crossings[chord.triangle()];
  return weights_on_side(crossings, side, side_position(crossings, side, chord.coordinate));
}

/// The same in the last triangle of a closed line, at the point where its first chord begins.
inline Vec3 weights_at_joint(const Sheet& sheet, const Chord& first, const Chord& last) {
  const double position = edge_position(sheet.crossings[first.triangle()], entry_side(sheet, first), first.coordinate);
  const auto& crossings = sheet.crossings[last.triangle()];
  const Role side = exit_side(sheet, last);
  return weights_on_side(crossings, side, crossings.is_reversed(side) ? 1 - position : position);
}

/// Calls visit(weights) for all points of a line, in the triangle of the chord after it, or of the last one.
template <class Visit>
void visit_weights(const Sheet& sheet, std::span<const Chord> chords, bool is_closed, const Visit& visit) {
  for (const auto& chord : chords) visit(weights_on_side(sheet, chord, entry_side(sheet, chord)));
  const auto& last = chords.back();
  visit(is_closed ? weights_at_joint(sheet, chords.front(), last)
                  : weights_on_side(sheet, last, exit_side(sheet, last)));
}

/// Calls visit(point) for all points of a line; a closed one ends where it begins.
template <class Visit>
void visit_points(const Sheet& sheet, std::span<const Chord> chords, bool is_closed, const Visit& visit) {
  const Vector first = point_on(sheet, chords.front(), entry_side(sheet, chords.front()));
  visit(first);
  const auto open_count = chords.size() - is_closed;
  for (const auto& chord : chords.first(open_count)) visit(point_on(sheet, chord, exit_side(sheet, chord)));
  if (is_closed) visit(first);
}

}  // namespace pectinate::detail
