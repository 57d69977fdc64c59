// SPDX-License-Identifier: MIT
#include "detail/left_atrium.hpp"

namespace pectinate::detail {

namespace {

constexpr double vestibule_fillet = 16;
constexpr double vein_fillet = 14;
constexpr double appendage_fillet = 9;

Box bounds(const LeftAtrium& atrium) {
  Box box = enclose(detail::bounds(atrium.chamber), detail::bounds(atrium.vestibule));
  for (const Sleeve& vein : atrium.veins) box = enclose(box, detail::bounds(vein.cone));
  for (const RoundCone& part : atrium.appendage) box = enclose(box, detail::bounds(part));
  return widen(box, vestibule_fillet / 6 + 1);  // blending swells by a sixth at most
}

}  // namespace

LeftAtrium make_left_atrium() {
  LeftAtrium atrium{.chamber = {Vector(0, 0, 0), Vector(35, 26, 29.5)},
                    .vestibule = {Vector(3, -5, -6), Vector(11.5, -23, -27.5), 21, 17},
                    .mitral_valve = {},
                    .veins = {make_sleeve("left_superior_pulmonary_vein", {17, 8, 13}, {45, 20, 31.5}, 7.5),
                              make_sleeve("left_inferior_pulmonary_vein", {17, 8.5, -6}, {48, 28.5, -12.5}, 7),
                              make_sleeve("right_superior_pulmonary_vein", {-17, 6, 12}, {-46, 15, 29.5}, 8),
                              make_sleeve("right_inferior_pulmonary_vein", {-17, 8.5, -6}, {-46, 30.5, -12.5}, 7)},
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
    for (const Sleeve& vein : atrium.veins) blended = smooth_union(blended, sample(vein.cone, point), vein_fillet);
    return smooth_union(blended, sample_appendage(atrium, point), appendage_fillet);
  };
  ImplicitSurface surface{function, {make_cut(atrium.mitral_valve)}, bounds(atrium)};
  for (const Sleeve& vein : atrium.veins) surface.cuts.push_back(make_cut(vein.ostium));
  return surface;
}

}  // namespace pectinate::detail
