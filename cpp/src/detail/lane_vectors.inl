// SPDX-License-Identifier: MIT
// Numbers and vectors side by side in a processor's registers, which hold `doubles` of them: for files that are
// compiled once for each kind of processor (kernel_variants.inl).

using Lanes = double __attribute__((vector_size(doubles * sizeof(double))));
using Mask = decltype(Lanes{} < Lanes{});

struct LaneVector {
  Lanes x, y, z;
};
inline LaneVector operator-(const LaneVector& a, const LaneVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline LaneVector operator+(const LaneVector& a, const LaneVector& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline LaneVector operator/(const LaneVector& a, const Lanes& divisor) {
  return {a.x / divisor, a.y / divisor, a.z / divisor};
}
inline LaneVector operator*(const Lanes& factor, const LaneVector& a) {
  return {factor * a.x, factor * a.y, factor * a.z};
}
inline Lanes dot(const LaneVector& a, const LaneVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline LaneVector cross(const LaneVector& a, const LaneVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline Lanes all(double value) {
  return Lanes{} + value;
}
inline bool is_set_everywhere(const Mask& mask) {
  auto common = mask[0];
  for (int i = 1; i < doubles; ++i) common &= mask[i];
  return common != 0;
}
inline Lanes magnitude(const Lanes& a) {
  return reinterpret_cast<Lanes>(reinterpret_cast<Mask>(a) & std::numeric_limits<std::int64_t>::max());
}
inline Lanes least(const Lanes& a, const Lanes& b) {
  return a < b ? a : b;
}
inline Lanes greatest(const Lanes& a, const Lanes& b) {
  return a > b ? a : b;
}
inline Lanes clamp(const Lanes& a, const Lanes& low, const Lanes& high) {
  return least(greatest(a, low), high);
}
inline Lanes root(const Lanes& a) {
  const Lanes square = greatest(a, all(0));
  Lanes result;
  for (int i = 0; i < doubles; ++i) result[i] = __builtin_sqrt(square[i]);
  return result;
}

/// `value(0)`, `value(1)`, ...: put together here, because what was just written one by one is slow to load as a whole.
template <class Value>
inline Lanes lanes(const Value& value) {
  if constexpr (doubles == 4) {
    return Lanes{value(0), value(1), value(2), value(3)};
  } else {
    return Lanes{value(0), value(1)};
  }
}
