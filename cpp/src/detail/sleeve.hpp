// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "detail/implicit_surface.hpp"

namespace pectinate::detail {

/// A vessel that leaves a body; its cone runs on beyond the cut.
struct Sleeve {
  std::string name;
  RoundCone cone;
  PlanarCut ostium;
};

/// Of `radius` at the ostium and somewhat wider at the root.
Sleeve make_sleeve(std::string name, const Vector& root, const Vector& ostium, double radius);

/// The cut across a cone, `overhang` before the centre of its end; takes all of the cone beyond.
PlanarCut cut_end(const RoundCone& cone, double overhang);

}  // namespace pectinate::detail
