// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "detail/implicit_surface.hpp"

namespace pectinate::detail {

/// Balls along a curve; a surface near the curve is cut to a band by them.
struct Band {
  std::vector<RoundCone> pieces;
  Box bounds;
};

/// The curve through `points`, smooth, drawn onto the zero set of `function`; `radii` at the points.
Band lay_band(const std::function<Sample(const Vector&)>& function, const std::vector<Vector>& points,
              const std::vector<double>& radii);

Sample sample(const Band& band, const Vector& point);

}  // namespace pectinate::detail
