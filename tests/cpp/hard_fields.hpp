// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "fields.hpp"

namespace pectinate::test {

/// Fields that ask much of the engine, by name.
struct NamedField {
  const char* name;
  detail::Vector (*at)(const detail::Vector& centre, double noise);
};

inline constexpr NamedField hard_fields[] = {
    {"noise",
     [](const detail::Vector&, double noise) { return detail::Vector(std::cos(9 * noise), std::sin(9 * noise), 0); }},
    {"patches of zero",
     [](const detail::Vector& c, double noise) {
       return noise < 0.4 ? detail::Vector(0, 0, 0) : detail::Vector(1, std::sin(c.x()), 0);
     }},
    {"patches of not a number",
     [](const detail::Vector& c, double noise) {
       return noise < 0.2 ? detail::Vector(std::nan(""), 0, 0) : detail::Vector(std::cos(c.y()), 1, 0);
     }},
    {"convergent edges",
     [](const detail::Vector& c, double) { return detail::Vector(c.x() < 6.1 ? 0.2 : -0.2, 1, 0); }},
    {"turns everywhere",
     [](const detail::Vector& c, double) {
       return std::fmod(c.x() + 2 * c.y(), 2) < 1 ? detail::Vector(1, 0.1, 0) : detail::Vector(0.1, 1, 0);
     }},
    {"vortex", [](const detail::Vector& c, double) { return detail::Vector(-(c.y() - 4.2), c.x() - 6.3, 0); }},
    {"spiral",
     [](const detail::Vector& c, double) {
       const detail::Vector r = c - detail::Vector(6.3, 4.2, 0);
       return detail::Vector(-r.y() + 0.06 * r.x(), r.x() + 0.06 * r.y(), 0);
     }},
    {"sink", [](const detail::Vector& c, double) { return detail::Vector(c - detail::Vector(6.3, 4.2, 0)); }},
    {"wedge",
     [](const detail::Vector& c, double) {
       const double half = std::atan2(c.y() - 4.2, c.x() - 6.3) / 2;
       return detail::Vector(std::cos(half), std::sin(half), 0);
     }},
};

inline OrientationField make_field(const SurfaceMesh& mesh, const NamedField& field) {
  Random random(3);
  return field_of(mesh, [&](const detail::Vector& c, const detail::Vector&) { return field.at(c, random.unit()); });
}

inline OrientationField hard_field(const SurfaceMesh& mesh, std::string_view name) {
  const auto hard =
      std::find_if(std::begin(hard_fields), std::end(hard_fields), [&](const auto& one) { return name == one.name; });
  return make_field(mesh, *hard);
}

}  // namespace pectinate::test
