// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pectinate/named_loop.hpp"
#include "pectinate/types.hpp"

namespace pectinate {

struct DemoAtriumOptions {
  /// Target edge length in mm, in [0.2, 4]. 1 mm gives about 43,000 triangles.
  double edge_length = 1.0;
};

/// An atrium-like surface with a smooth orientation field, in millimetres; x to the patient's left, y to posterior,
/// z to superior.
struct DemoAtrium {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;        ///< counter-clockwise seen from outside
  std::vector<Vec3> directions;           ///< unit vector per triangle, tangent to it; the sign means nothing
  std::vector<std::int32_t> regions;      ///< region tag per triangle, see `region_names`
  std::vector<std::string> region_names;  ///< index = tag; body, the four veins, appendage
  std::vector<NamedLoop> loops;           ///< the mitral valve and the four pulmonary veins
};

/// Generates a dilated left atrium: a body, four pulmonary veins, an appendage and an open mitral valve, each opening
/// cut by a plane. One component, genus 0, five boundary loops, nearly equilateral triangles.
///
/// Deterministic: the same bytes for the same options. Throws InvalidOption for an edge length out of range.
DemoAtrium make_demo_atrium(const DemoAtriumOptions& options = {});

}  // namespace pectinate
