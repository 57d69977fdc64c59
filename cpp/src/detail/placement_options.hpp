// SPDX-License-Identifier: MIT
#pragma once

#include "pectinate/placement.hpp"

namespace pectinate::detail {

/// Throws InvalidOption; what depends on the surface is checked elsewhere.
void check(const PlacementOptions& options);

/// Are streamlines to be polished?
inline bool polishes(const PlacementOptions& options) {
  return options.polishing_rounds > 0 || options.polishing_time > 0;
}

}  // namespace pectinate::detail
