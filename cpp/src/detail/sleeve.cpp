// SPDX-License-Identifier: MIT
#include "detail/sleeve.hpp"

#include <utility>

namespace pectinate::detail {

Sleeve make_sleeve(std::string name, const Vector& root, const Vector& ostium, double radius) {
  const double overhang = 4, flare = 1.5;
  const Vector axis = (ostium - root).normalized();
  const RoundCone cone{root, ostium + overhang * axis, radius + flare, radius};
  return {std::move(name), cone, cut_end(cone, overhang)};
}

PlanarCut cut_end(const RoundCone& cone, double overhang) {
  return {cone.end - overhang * cone.axis(), cone.axis(), overhang + 1.2 * cone.end_radius};
}

}  // namespace pectinate::detail
