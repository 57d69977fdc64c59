// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pectinate {

/// A closed border of a generated surface: `vertices` in order along it, the surface on their left, no repetition.
struct NamedLoop {
  std::string name;
  std::vector<std::int32_t> vertices;
};

}  // namespace pectinate
