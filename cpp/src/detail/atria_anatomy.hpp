// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "detail/implicit_surface.hpp"

namespace pectinate::detail {

/// One named part of a chamber, before it is blended with the others.
struct ChamberPart {
  std::string name;
  std::function<Sample(const Vector&)> function;
};

struct NamedCut {
  std::string name;
  Cut cut;
};

/// The outside of a chamber, closed, with the cuts that open it. Coordinates in mm; x to the patient's left, y to
/// posterior, z to superior; both atria lie in one frame.
struct Chamber {
  std::vector<ChamberPart> parts;  ///< the body first
  std::function<Sample(const Vector&)> function;
  std::vector<NamedCut> openings;
  Box bounds;
};

Chamber make_left_chamber();
Chamber make_right_chamber();
/// The two chambers' common outside, moved outwards, cut down to the bundle by its single opening.
Chamber make_bachmann_bundle();

}  // namespace pectinate::detail
