// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "detail/implicit_surface.hpp"
#include "detail/sleeve.hpp"

namespace pectinate::detail {

/// Parts of a dilated left atrium, in mm; x to the patient's left, y to posterior, z to superior.
struct LeftAtrium {
  Ellipsoid chamber;
  RoundCone vestibule;  ///< leads to the mitral valve
  PlanarCut mitral_valve;
  std::array<Sleeve, 4> veins;
  std::array<RoundCone, 2> appendage;  ///< from its mouth to the bend, from there to the tip
};

LeftAtrium make_left_atrium();

Sample sample_body(const LeftAtrium& atrium, const Vector& point);
Sample sample_appendage(const LeftAtrium& atrium, const Vector& point);

/// All parts blended; the cuts are the mitral valve, then the veins in their order.
ImplicitSurface make_surface(const LeftAtrium& atrium);

}  // namespace pectinate::detail
