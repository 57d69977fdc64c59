// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pectinate/named_loop.hpp"
#include "pectinate/types.hpp"

namespace pectinate {

enum class AtrialSurface { left_atrium, right_atrium, bachmann_bundle };
enum class AtrialLayer { epicardium, endocardium };

/// In mm, how far inside the epicardium the endocardium lies where a wall is even; more at its fillets.
constexpr double atrial_wall_thickness = 2;

struct AtriaOptions {
  /// Target edge length in mm, in [0.1, 2]. At 1 mm the epicardium of all three surfaces has about 43,700 triangles.
  double edge_length = 1.0;
};

/// A surface with its openings, in millimetres.
struct GeneratedSurface {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;        ///< counter-clockwise seen from outside
  std::vector<std::int32_t> regions;      ///< region tag per triangle, see `region_names`
  std::vector<std::string> region_names;  ///< index = tag
  std::vector<NamedLoop> loops;           ///< all its borders
};

/// Generates one surface of both atria, which share a frame: x to the patient's left, y to posterior, z to superior.
///
/// - Left atrium: a body, four pulmonary veins and an appendage; the mitral valve, the veins and the fossa ovalis are
///   open.
/// - Right atrium: a body, both venae cavae, the coronary sinus and an appendage; the tricuspid valve, the vessels and
///   the fossa ovalis are open.
/// - Bachmann's bundle: a band above both, with one border; it has an epicardium only.
///
/// One component, genus 0, nearly equilateral triangles. Deterministic: the same bytes for the same options. Throws
/// InvalidOption for an edge length out of range and for the endocardium of Bachmann's bundle.
GeneratedSurface make_atrial_surface(AtrialSurface which, AtrialLayer layer, const AtriaOptions& options = {});

}  // namespace pectinate
