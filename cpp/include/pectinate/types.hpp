// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace pectinate {

/// A point or vector in space; lengths are in the unit of the mesh (millimetres in the Python layer).
using Vec3 = std::array<double, 3>;

/// Corner vertex indices of a triangle. Side k of a triangle joins corners k and (k + 1) % 3.
using Triangle = std::array<std::int32_t, 3>;

}  // namespace pectinate
