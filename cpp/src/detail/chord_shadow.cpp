// SPDX-License-Identifier: MIT
#include "detail/chord_shadow.hpp"

namespace pectinate::detail {

#define PECTINATE_KERNEL "detail/chord_shadow_lanes.inl"
#include "detail/kernel_variants.inl"

ChordIntervals chord_shadows(const ChordFrame& frame, const Capsules& capsules) {
  return PECTINATE_CALL_KERNEL(chord_shadows, frame, capsules);
}

std::array<ChordIntervals, 2> chord_cores(const ChordFrame& frame, const Capsules& capsules) {
  return PECTINATE_CALL_KERNEL(chord_cores, frame, capsules);
}

}  // namespace pectinate::detail
