// SPDX-License-Identifier: MIT
#include "detail/chord_shadow.hpp"

#include <cstdint>
#include <limits>

namespace pectinate::detail {

#define PECTINATE_KERNEL "detail/chord_shadow_lanes.inl"
#include "detail/kernel_variants.inl"

Shadows chord_shadows(const ShadowQuestions& questions) {
  return PECTINATE_CALL_KERNEL(chord_shadows, questions);
}

std::array<ChordIntervals, 2> chord_cores(const ShadowQuestions& questions) {
  return PECTINATE_CALL_KERNEL(chord_cores, questions);
}

}  // namespace pectinate::detail
