// SPDX-License-Identifier: MIT
// What segments.cpp compiles once for each kind of processor; its registers hold `floats` numbers.

using Lanes = float __attribute__((vector_size(floats * sizeof(float))));

inline Lanes load(const Segments::Numbers& numbers, int first) {
  Lanes result;
  __builtin_memcpy(&result, &numbers[first], sizeof result);
  return result;
}
inline Lanes least(const Lanes& a, const Lanes& b) {
  return a < b ? a : b;
}
inline Lanes greatest(const Lanes& a, const Lanes& b) {
  return a > b ? a : b;
}
inline Lanes all(float value) {
  return Lanes{} + value;
}
/// By halves: one after the other they would wait for each other.
inline float least_of(const Lanes& lanes) {
  using Four = float __attribute__((vector_size(4 * sizeof(float))));
  Four four;
  __builtin_memcpy(&four, &lanes, sizeof four);
  for (int i = 4; i < floats; i += 4) {
    Four next;
    __builtin_memcpy(&next, reinterpret_cast<const float*>(&lanes) + i, sizeof next);
    four = four < next ? four : next;
  }
  const Four halves = __builtin_shufflevector(four, four, 2, 3, 0, 1);
  four = four < halves ? four : halves;
  const Four pairs = __builtin_shufflevector(four, four, 1, 0, 3, 2);
  four = four < pairs ? four : pairs;
  return four[0];
}
/// One bit for each lane of a comparison.
inline unsigned bits(const decltype(Lanes{} < Lanes{})& mask) {
#ifdef PECTINATE_SIGN_BITS
  return static_cast<unsigned>(PECTINATE_SIGN_BITS(reinterpret_cast<const Lanes&>(mask)));
#else
  unsigned result = 0;
  for (int i = 0; i < floats; ++i) result |= static_cast<unsigned>(mask[i] & 1) << i;
  return result;
#endif
}

inline float distance(Segments& segments, const FloatPoint& point) {
  Lanes nearest = all(1e30F);
  const int count = segments.padded_count();
  for (int i = 0; i < count; i += floats) {
    Lanes x = point.x - load(segments.x, i), y = point.y - load(segments.y, i), z = point.z - load(segments.z, i);
    const Lanes dx = load(segments.dx, i), dy = load(segments.dy, i), dz = load(segments.dz, i);
    const Lanes projected = (x * dx + y * dy + z * dz) * load(segments.inverse_square, i);
    const Lanes along = least(greatest(projected, all(0)), all(1));
    x -= along * dx;
    y -= along * dy;
    z -= along * dz;
    const Lanes square = x * x + y * y + z * z;
    __builtin_memcpy(&segments.square[i], &square, sizeof square);
    nearest = least(nearest, square);
  }
  return __builtin_sqrtf(least_of(nearest));
}

inline SegmentsNear segments_near(const Segments& segments, int group, const TriangleQuestion& question) {
  SegmentsNear result{0, 0, 0};
  for (int i = 0; i < Segments::group_size; i += floats) {
    const int first = group + i;
    const Lanes limit = question.radius + question.share * load(segments.reach, first);
    const unsigned are_near = bits(load(segments.square, first) <= limit * limit);
    if (are_near == 0) continue;
    Lanes lowest = all(1e30F), highest = all(-1e30F);
    for (const auto& corner : question.corners) {
      const Lanes along = (corner.x - load(segments.x, first)) * load(segments.dx, first) +
                          (corner.y - load(segments.y, first)) * load(segments.dy, first) +
                          (corner.z - load(segments.z, first)) * load(segments.dz, first);
      lowest = least(lowest, along);
      highest = greatest(highest, along);
    }
    const Lanes length = load(segments.length, first), slack = all(question.slack);
    result.are_near |= are_near << i;
    result.lie_before |= (are_near & bits(highest + slack * length < 0)) << i;
    result.lie_beyond |= (are_near & bits(lowest > (length + slack) * length)) << i;
  }
  return result;
}
