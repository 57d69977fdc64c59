// SPDX-License-Identifier: MIT
#include "detail/left_atrium.hpp"

#include <utility>

namespace pectinate::detail {

namespace {

constexpr double vestibule_fillet = 16;
constexpr double vein_fillet = 14;
constexpr double appendage_fillet = 9;

/// The cut across the end of a cone; takes all of the cone beyond.
PlanarCut cut_end(const RoundCone& cone, double overhang) {
  return {cone.end - overhang * cone.axis(), cone.axis(), overhang + 1.5 * cone.end_radius};
}

PulmonaryVein make_vein(std::string name, const Vector& root, const Vector& ostium, double radius) {
  const double overhang = 4;
  const Vector axis = (ostium - root).normalized();
  const RoundCone sleeve{root, ostium + overhang * axis, radius + 1.5, radius};
  return {std::move(name), sleeve, cut_end(sleeve, overhang)};
}

/// The box round both spheres.
void enclose(Box& box, const RoundCone& cone) {
  for (const auto& [centre, radius] : {std::pair{cone.start, cone.start_radius}, {cone.end, cone.end_radius}}) {
    box.lower = box.lower.cwiseMin((centre.array() - radius).matrix());
    box.upper = box.upper.cwiseMax((centre.array() + radius).matrix());
  }
}

Box bounds(const LeftAtrium& atrium) {
  Box box{atrium.chamber.centre - atrium.chamber.radii, atrium.chamber.centre + atrium.chamber.radii};
  enclose(box, atrium.vestibule);
  for (const PulmonaryVein& vein : atrium.veins) enclose(box, vein.sleeve);
  for (const RoundCone& part : atrium.appendage) enclose(box, part);
  const Vector fillet_margin = Vector::Constant(vestibule_fillet / 6 + 1);  // blending swells by a sixth at most
  return {box.lower - fillet_margin, box.upper + fillet_margin};
}

}  // namespace

LeftAtrium make_left_atrium() {
  LeftAtrium atrium{.chamber = {Vector(0, 0, 0), Vector(35, 26, 29.5)},
                    .vestibule = {Vector(3, -5, -6), Vector(11.5, -23, -27.5), 21, 17},
                    .mitral_valve = {},
                    .veins = {make_vein("left_superior_pulmonary_vein", {17, 8, 13}, {45, 20, 31.5}, 7.5),
                              make_vein("left_inferior_pulmonary_vein", {17, 8.5, -6}, {48, 28.5, -12.5}, 7),
                              make_vein("right_superior_pulmonary_vein", {-17, 6, 12}, {-46, 15, 29.5}, 8),
                              make_vein("right_inferior_pulmonary_vein", {-17, 8.5, -6}, {-46, 30.5, -12.5}, 7)},
                    .appendage = {{{Vector(21, -9.5, 7.5), Vector(42, -25, 11.5), 10.5, 8.5},
                                   {Vector(42, -25, 11.5), Vector(42, -46, 2), 8.5, 6}}}};
  atrium.mitral_valve = cut_end(atrium.vestibule, 0);
  return atrium;
}

Sample sample_body(const LeftAtrium& atrium, const Vector& point) {
  return smooth_union(sample(atrium.chamber, point), sample(atrium.vestibule, point), vestibule_fillet);
}

Sample sample_appendage(const LeftAtrium& atrium, const Vector& point) {
  return smooth_union(sample(atrium.appendage[0], point), sample(atrium.appendage[1], point), appendage_fillet);
}

ImplicitSurface make_surface(const LeftAtrium& atrium) {
  const auto function = [atrium](const Vector& point) {
    Sample blended = sample_body(atrium, point);
    for (const PulmonaryVein& vein : atrium.veins)
      blended = smooth_union(blended, sample(vein.sleeve, point), vein_fillet);
    return smooth_union(blended, sample_appendage(atrium, point), appendage_fillet);
  };
  ImplicitSurface surface{function, {atrium.mitral_valve}, bounds(atrium)};
  for (const PulmonaryVein& vein : atrium.veins) surface.cuts.push_back(vein.ostium);
  return surface;
}

}  // namespace pectinate::detail
