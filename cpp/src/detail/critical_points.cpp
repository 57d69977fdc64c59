// SPDX-License-Identifier: MIT
#include "detail/critical_points.hpp"

#include <utility>

namespace pectinate::detail {

std::vector<CriticalPoint> critical_points(const std::vector<Triangle>& triangles, const std::vector<double>& values,
                                           const std::vector<bool>& left_out) {
  const auto is_above = [&](std::int32_t a, std::int32_t b) {
    return std::pair(values[a], a) > std::pair(values[b], b);
  };
  // Each triangle at a vertex holds one side of its link.
  std::vector<std::int32_t> sign_changes(values.size(), 0);
  std::vector<bool> varies(values.size(), false);
  for (const auto& corners : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = corners[k], a = corners[(k + 1) % 3], b = corners[(k + 2) % 3];
      sign_changes[v] += is_above(a, v) != is_above(b, v);
      if (values[a] != values[v] || values[b] != values[v]) varies[v] = true;
    }
  }
  std::vector<CriticalPoint> points;
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(values.size()); ++v) {
    const std::int32_t index = 1 - sign_changes[v] / 2;
    if (index != 0 && varies[v] && !left_out[v]) points.push_back({v, index});
  }
  return points;
}

}  // namespace pectinate::detail
