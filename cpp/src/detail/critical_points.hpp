// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "pectinate/reference_frame.hpp"

namespace pectinate::detail {

/// The vertices at which a function, linear in every triangle, rises and falls other than once around the link: index
/// 1 - (changes of sign) / 2. Equal values are told apart by the vertices' numbers; vertices around which the function
/// is constant, and those `left_out` (all border vertices), are passed over. Ascending.
std::vector<CriticalPoint> critical_points(const std::vector<Triangle>& triangles, const std::vector<double>& values,
                                           const std::vector<bool>& left_out);

}  // namespace pectinate::detail
