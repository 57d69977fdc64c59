// SPDX-License-Identifier: MIT
// What chord_measures.cpp compiles once for each kind of processor, whose registers hold `doubles` numbers.

#include "detail/lane_vectors.inl"

/// Keeps chords apart from sides in triangles so thin that no orientation is away from all of them.
constexpr double least_split = 1e-12;

/// One bit for each lane.
inline unsigned bits(const Mask& mask) {
  unsigned result = 0;
  for (int i = 0; i < doubles; ++i) result |= static_cast<unsigned>(mask[i] & 1) << i;
  return result;
}

/// Of the lanes from `first` on.
inline LaneVector load(const Faces::Places& places, int first) {
  const auto coordinate = [&](int k) { return lanes([&](int lane) { return (*places[first + lane])[k]; }); };
  return {coordinate(0), coordinate(1), coordinate(2)};
}
inline void store(const Lanes& values, ChordMeasures::Numbers& numbers, int first) {
  __builtin_memcpy(&numbers[first], &values, sizeof values);
}

/// The one of three that the masks tell.
inline Lanes choose(const Mask& is_first, const Mask& is_second, const std::array<Lanes, 3>& of) {
  return is_first ? of[0] : (is_second ? of[1] : of[2]);
}

inline void measure(const Faces& faces, int first, ChordMeasures& result) {
  const LaneVector a = load(faces.corners[0], first), b = load(faces.corners[1], first);
  const LaneVector c = load(faces.corners[2], first), along = load(faces.directions, first);
  const std::array<LaneVector, 3> sides = {b - a, c - b, a - c};
  const LaneVector upwards = cross(sides[0], c - a);
  const LaneVector across = cross(upwards / root(dot(upwards, upwards)), along);
  std::array<Lanes, 3> rise, run, size;
  Mask is_close = all(1) < 0;
  for (int k = 0; k < 3; ++k) {
    rise[k] = dot(sides[k], across);
    run[k] = dot(sides[k], along);
    size[k] = magnitude(rise[k]);
    is_close |= size[k] < least_angle_to_side * magnitude(run[k]);
    // Inside is to the left of a side; the orientation runs there if the side falls across it.
    const Lanes cosine = run[k] / root(rise[k] * rise[k] + run[k] * run[k]);
    store(rise[k] < 0 ? cosine : -cosine, result.cosine[k], first);
  }
  // At the corner between the others the two sides beside it turn the same way.
  const Mask falls0 = rise[0] <= 0, falls1 = rise[1] <= 0, falls2 = rise[2] <= 0;
  const Mask is_first = ~(falls2 ^ falls0), is_second = ~(falls0 ^ falls1);
  const auto opposite = [&](const std::array<Lanes, 3>& of) {
    return choose(is_first, is_second, {of[1], of[2], of[0]});
  };
  const Lanes share = -choose(is_first, is_second, rise) / opposite(rise);
  const Lanes above = share > least_split ? share : all(least_split);
  const Lanes split = above < 1 - least_split ? above : all(1 - least_split);
  store(choose(is_first, is_second, {all(0), all(1), all(2)}), result.middle, first);
  store(split, result.split, first);
  store(magnitude(choose(is_first, is_second, run) + split * opposite(run)), result.longest_chord, first);
  store(opposite(size), result.width, first);
  result.along_sides |= bits(is_close) << first;
}

inline ChordMeasures measure_chords(const Faces& faces) {
  ChordMeasures result;
  result.along_sides = 0;
  for (int first = 0; first < measured_lanes; first += doubles) measure(faces, first, result);
  return result;
}
