// SPDX-License-Identifier: MIT
// What chord_shadow.cpp compiles once for each kind of processor. There are no branches to be guessed wrongly: all
// lanes take all ways, and choose.

#include "detail/lane_vectors.inl"

/// Of the lanes from `first` on.
inline LaneVector load(const ShadowQuestions::Places& places, int first) {
  const auto coordinate = [&](int k) { return lanes([&](int lane) { return (*places[first + lane])[k]; }); };
  return {coordinate(0), coordinate(1), coordinate(2)};
}
inline Lanes load(const ShadowQuestions::Numbers& numbers, int first) {
  return lanes([&](int lane) { return numbers[first + lane]; });
}
inline void store(const Lanes& values, ShadowQuestions::Numbers& numbers, int first) {
  __builtin_memcpy(&numbers[first], &values, sizeof values);
}

/// Triangles laid flat: x along their chords, w across them, from the low corner at the origin to the high one.
struct ChordFrame {
  LaneVector low, along, across, normal;  // a corner, and unit vectors
  Lanes split, width, high_x, middle_x;
};

inline ChordFrame lay_flat(const ShadowQuestions& questions, int first) {
  ChordFrame frame;
  frame.low = load(questions.low, first);
  frame.split = load(questions.split, first);
  const LaneVector middle = load(questions.middle, first), low_to_high = load(questions.high, first) - frame.low;
  const LaneVector chord = frame.low + frame.split * low_to_high - middle;
  frame.along = chord / root(dot(chord, chord));
  frame.high_x = dot(frame.along, low_to_high);
  frame.middle_x = dot(frame.along, middle - frame.low);
  const LaneVector across = low_to_high - frame.high_x * frame.along;
  frame.width = root(dot(across, across));
  frame.across = across / frame.width;
  frame.normal = cross(frame.along, frame.across);
  return frame;
}

/// Capsules in the frame's coordinates, and what is often asked about them.
struct FlatCapsules {
  LaneVector start, axis;
  Lanes radius, radius_square, axis_square, inverse;
};

inline FlatCapsules flatten(const ChordFrame& frame, const ShadowQuestions& questions, int first) {
  const auto flat = [&](const ShadowQuestions::Places& places) -> LaneVector {
    const LaneVector from_low = load(places, first) - frame.low;
    return {dot(from_low, frame.along), dot(from_low, frame.across), dot(from_low, frame.normal)};
  };
  FlatCapsules result;
  result.start = flat(questions.start);
  result.axis = flat(questions.end) - result.start;
  result.radius = load(questions.radius, first);
  result.radius_square = result.radius * result.radius;
  result.axis_square = dot(result.axis, result.axis);
  const Mask has_length = result.axis_square > 0;
  result.inverse = has_length ? 1 / (has_length ? result.axis_square : all(1)) : all(0);
  return result;
}

/// A corner of the triangle as capsules see it.
struct Corner {
  Lanes along;        // the axis, in [0, 1] beside it
  LaneVector across;  // from the axis' line
  Lanes square;       // of `across`
  Mask inside;        // the capsule
};

inline Corner look(const FlatCapsules& capsules, const Lanes& x, const Lanes& w) {
  const LaneVector from_start{x - capsules.start.x, w - capsules.start.y, -capsules.start.z};
  const Lanes along = dot(from_start, capsules.axis) * capsules.inverse;
  const LaneVector across = from_start - along * capsules.axis;
  const Lanes beyond = along - clamp(along, all(0), all(1)), square = dot(across, across);
  return {along, across, square, square + beyond * beyond * capsules.axis_square <= capsules.radius_square};
}

struct View {
  Corner low, middle, high;
};

inline View look(const FlatCapsules& capsules, const ChordFrame& frame) {
  return {look(capsules, all(0), all(0)), look(capsules, frame.middle_x, frame.split * frame.width),
          look(capsules, frame.high_x, frame.width)};
}

/// Something in [0, 1], where there is something.
struct Place {
  Lanes at;
  Mask is_some;
};
struct Part {
  Lanes low, high;
  Mask is_some;
};

/// Chords from the lowest to the highest of some.
struct Hull {
  Lanes low = all(2), high = all(-1);

  void include(const Part& part) {
    low = part.is_some ? least(low, part.low) : low;
    high = part.is_some ? greatest(high, part.high) : high;
  }
};

/// A side as capsules see it: its rise along the axis, and the quadratic equations of cylinder and balls.
struct Side {
  const Corner &from, &to;
  Lanes rise, a, b, root, inverse_a;
  Lanes ball_a, inverse_ball_a;
};

/// Where a side enters (sign -1) or leaves (1) the capsules.
inline Place crossing(const FlatCapsules& capsules, const Side& side, double sign) {
  const Corner& from = side.from;
  const Lanes on_cylinder = (sign * side.root - side.b) * side.inverse_a;
  const Lanes along = from.along + on_cylinder * side.rise;
  const Mask is_beside = (along >= 0) & (along <= 1);
  // Beyond an end of the axis, it is the ball there that counts.
  const Lanes outside = side.a > 0 ? along : (sign < 0 ? from : side.to).along;
  const Lanes start = outside > 1 ? from.along - 1 : from.along;
  const Lanes b = side.b + start * side.rise * capsules.axis_square;
  const Lanes c = from.square + start * start * capsules.axis_square - capsules.radius_square;
  const Lanes discriminant = b * b - side.ball_a * c, on_ball = (sign * root(discriminant) - b) * side.inverse_ball_a;
  return {is_beside ? on_cylinder : on_ball, is_beside | (discriminant >= 0)};
}

/// The part of the side between two corners that is inside the capsules.
inline Part part_inside(const FlatCapsules& capsules, const Corner& from, const Corner& to) {
  const LaneVector e = to.across - from.across;
  const Lanes rise = to.along - from.along, a = dot(e, e), b = dot(e, from.across);
  // Even the axis' line is too far away.
  const Mask misses =
      ((b >= 0) & (from.square > capsules.radius_square)) | ((b <= -a) & (to.square > capsules.radius_square));
  const Lanes discriminant = b * b - a * (from.square - capsules.radius_square);
  const Lanes ball_a = a + rise * rise * capsules.axis_square;
  const Side side{from, to, rise, a, b, root(discriminant), 1 / a, ball_a, 1 / ball_a};
  const Place entry = crossing(capsules, side, -1), exit = crossing(capsules, side, 1);
  const Lanes low = from.inside ? all(0) : greatest(entry.at, all(0));
  const Lanes high = to.inside ? all(1) : least(exit.at, all(1));
  const Mask enters = from.inside | (entry.is_some & (entry.at <= 1));
  const Mask leaves = to.inside | (exit.is_some & (exit.at >= low));
  return {low, high, (from.inside & to.inside) | (~misses & (discriminant >= 0) & enters & leaves)};
}

inline Mask contains(const ChordFrame& frame, const Lanes& x, const Lanes& chord) {
  const Lanes from_long = x - chord * frame.high_x;
  const Lanes below = x * frame.split - chord * frame.middle_x;
  const Lanes above =
      (x - frame.middle_x) * (1 - frame.split) - (chord - frame.split) * (frame.high_x - frame.middle_x);
  return (chord >= 0) & (chord <= 1) & (from_long * (chord < frame.split ? below : above) <= 0);
}

/// The chords at which the capsules' cuts with the plane are lowest and highest, if inside the triangle.
inline std::array<Place, 2> extremes(const FlatCapsules& capsules, const ChordFrame& frame) {
  const auto& [start, axis, radius, radius_square, axis_square, inverse] = capsules;
  const Lanes h = start.z, dh = axis.z, dw = axis.y;
  // The part of the axis whose height over the plane is within the radius.
  const Mask is_level = dh == 0;
  const Lanes rise = is_level ? all(1) : dh;
  const Lanes inverse_rise = 1 / rise, one = (-radius - h) * inverse_rise, other = (radius - h) * inverse_rise;
  const Lanes low = is_level ? all(0) : greatest(least(one, other), all(0));
  const Lanes high = is_level ? all(1) : least(greatest(one, other), all(1));
  const Mask is_near = (low <= high) & ~(is_level & (h * h > radius_square));
  // Balls around the segment cut discs out of the plane. Of these, w + t dw +- sqrt(radius^2 - (h + t dh)^2) is extreme
  // at the height at which both terms change alike.
  const Lanes slope = root(dw * dw + dh * dh);
  const Lanes extreme_height = (dh < 0 ? -radius : radius) * dw / (slope > 0 ? slope : all(1));
  const Lanes inverse_width = 1 / frame.width;
  const auto extreme = [&](double sign) -> Place {
    const Lanes bent = clamp((sign * extreme_height - h) * inverse_rise, low, high);
    const Lanes t = is_level ? (sign * dw > 0 ? high : low) : bent;
    const Lanes height = h + t * dh, disc_radius = root(radius_square - height * height);
    const Lanes chord = (start.y + t * dw + sign * disc_radius) * inverse_width;
    return {chord, is_near & contains(frame, start.x + t * axis.x, chord)};
  };
  return {extreme(-1), extreme(1)};
}

inline Hull shadows(const ChordFrame& frame, const FlatCapsules& capsules) {
  const auto [low, middle, high] = look(capsules, frame);
  Hull hull;
  hull.include({all(0), all(0), low.inside});
  hull.include({all(1), all(1), high.inside});
  for (const auto& [at, is_some] : extremes(capsules, frame)) hull.include({at, at, is_some});
  // What is extreme outside the triangle is cut off at its sides.
  hull.include(part_inside(capsules, low, high));
  const auto below = part_inside(capsules, low, middle), above = part_inside(capsules, middle, high);
  hull.include({below.low * frame.split, below.high * frame.split, below.is_some});
  const Lanes rest = 1 - frame.split;
  hull.include({frame.split + above.low * rest, frame.split + above.high * rest, above.is_some});
  return hull;
}

inline std::array<Hull, 2> cores(const ChordFrame& frame, const FlatCapsules& capsules) {
  const auto [low, middle, high] = look(capsules, frame);
  // A chord lies in a convex set if both its ends do: one on low-high, the other on one of the other sides.
  const auto one_end = part_inside(capsules, low, high);
  const auto both_ends = [&](const Part& other_end, const Lanes& from, const Lanes& to) {
    Hull hull;
    hull.include({greatest(one_end.low, from + other_end.low * (to - from)),
                  least(one_end.high, from + other_end.high * (to - from)), one_end.is_some & other_end.is_some});
    return hull;
  };
  return {both_ends(part_inside(capsules, low, middle), all(0), frame.split),
          both_ends(part_inside(capsules, middle, high), frame.split, all(1))};
}

inline void store(const Hull& hull, ChordIntervals& intervals, int first) {
  store(hull.low, intervals.low, first);
  store(hull.high, intervals.high, first);
}

inline Shadows chord_shadows(const ShadowQuestions& questions) {
  Shadows result;
  for (int first = 0; first < shadow_lanes; first += doubles) {
    const auto frame = lay_flat(questions, first);
    store(shadows(frame, flatten(frame, questions, first)), result.chords, first);
    store(frame.width, result.width, first);
  }
  return result;
}

inline std::array<ChordIntervals, 2> chord_cores(const ShadowQuestions& questions) {
  std::array<ChordIntervals, 2> result;
  for (int first = 0; first < shadow_lanes; first += doubles) {
    const auto frame = lay_flat(questions, first);
    const auto hulls = cores(frame, flatten(frame, questions, first));
    for (const int part : {0, 1}) store(hulls[part], result[part], first);
  }
  return result;
}
