// SPDX-License-Identifier: MIT
#include "detail/chord_measures.hpp"

#include <cstdint>
#include <limits>

namespace pectinate::detail {

#define PECTINATE_KERNEL "detail/chord_measures_lanes.inl"
#include "detail/kernel_variants.inl"

ChordMeasures measure_chords(const Faces& faces) {
  return PECTINATE_CALL_KERNEL(measure_chords, faces);
}

}  // namespace pectinate::detail
