// SPDX-License-Identifier: MIT
#include "detail/atria_anatomy.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <utility>

#include "detail/band.hpp"
#include "detail/bent_cone.hpp"
#include "detail/sleeve.hpp"

namespace pectinate::detail {

namespace {

constexpr double vestibule_fillet = 12, septum_fillet = 5, vein_fillet = 9, cava_fillet = 10, sinus_fillet = 6;
constexpr double left_appendage_fillet = 6, right_appendage_fillet = 8;
constexpr double largest_fillet = vestibule_fillet;

/// Both atria are flat on either side of this plane; the fossa ovalis is a hole through both walls.
struct Septum {
  Vector centre{-3.4, 1.5, -0.5};  ///< of the fossa ovalis, between the walls
  Vector to_right = Vector(-0.74, -0.67, 0).normalized();
  double gap = 2;

  HalfSpace left_side() const { return {centre - gap / 2 * to_right, to_right}; }
  HalfSpace right_side() const { return {centre + gap / 2 * to_right, -to_right}; }

  /// The inside of an elliptic cylinder.
  Cut fossa() const {
    const double half_width = 7, half_height = 9;
    const Vector across = to_right.cross(Vector::UnitZ()).normalized();
    const Vector up = across.cross(to_right);
    const auto function = [=, centre = centre](const Vector& point) {
      const Vector from_centre = point - centre;
      const double u = across.dot(from_centre) / half_width, v = up.dot(from_centre) / half_height;
      return unit_slope({(1 - u * u - v * v) / 2, -(u / half_width * across + v / half_height * up)});
    };
    return {function, centre, half_height + 5};
  }
};

/// Blends parts, one after the other, into a chamber.
class Builder {
 public:
  Builder(const Ellipsoid& body, const RoundCone& vestibule, const HalfSpace& septum, std::string valve) {
    const auto function = [=](const Vector& point) {
      const Sample blended = smooth_union(sample(body, point), sample(vestibule, point), vestibule_fillet);
      return smooth_intersection(blended, sample(septum, point), septum_fillet);
    };
    chamber_.bounds = bounds(body);
    add({"body", function}, 0, bounds(vestibule));
    open(std::move(valve), make_cut(cut_end(vestibule, 0)));
  }

  void add(ChamberPart part, double fillet, const Box& box) {
    chamber_.parts.push_back(std::move(part));
    fillets_.push_back(fillet);
    chamber_.bounds = enclose(chamber_.bounds, box);
  }

  void add(const Sleeve& sleeve, double fillet) {
    const auto function = [cone = sleeve.cone](const Vector& point) { return sample(cone, point); };
    add({sleeve.name, function}, fillet, bounds(sleeve.cone));
    open(sleeve.name, make_cut(sleeve.ostium));
  }

  void open(std::string name, Cut cut) { chamber_.openings.push_back({std::move(name), std::move(cut)}); }

  Chamber finish() {
    chamber_.function = [parts = chamber_.parts, fillets = fillets_](const Vector& point) {
      Sample blended = parts[0].function(point);
      for (std::size_t i = 1; i < parts.size(); ++i)
        blended = smooth_union(blended, parts[i].function(point), fillets[i]);
      return blended;
    };
    chamber_.bounds = widen(chamber_.bounds, largest_fillet / 6 + 1);  // blending swells by a sixth at most
    return std::move(chamber_);
  }

 private:
  Chamber chamber_;
  std::vector<double> fillets_;
};

}  // namespace

Chamber make_left_chamber() {
  const Septum septum;
  Builder builder({Vector(10, 10, 2), Vector(23.5, 17, 19.5)}, {Vector(15, 4, -4), Vector(26, -7, -14), 18, 17},
                  septum.left_side(), "mitral_valve");
  builder.add(make_sleeve("left_superior_pulmonary_vein", {22, 14, 10}, {40.5, 22.5, 22}, 6.5), vein_fillet);
  builder.add(make_sleeve("left_inferior_pulmonary_vein", {22, 16, -4}, {40.5, 30, -7.5}, 6), vein_fillet);
  builder.add(make_sleeve("right_superior_pulmonary_vein", {-1, 15, 11}, {-21, 22.5, 19}, 6.5), vein_fillet);
  builder.add(make_sleeve("right_inferior_pulmonary_vein", {-2, 16, -4}, {-20, 30, -8.5}, 6), vein_fillet);
  const BentCone appendage({Vector(24, 0, 9), Vector(36, -30, 8), 8, 4.5}, Vector(1, -0.35, 0.25));
  builder.add({"left_atrial_appendage", [=](const Vector& point) { return appendage.sample(point); }},
              left_appendage_fillet, appendage.bounds());
  builder.open("fossa_ovalis", septum.fossa());
  return builder.finish();
}

Chamber make_right_chamber() {
  const Septum septum;
  Builder builder({Vector(-17.5, -7.5, -2), Vector(20, 19, 26)}, {Vector(-17, -11, -7), Vector(-5, -24, -18), 20, 19.5},
                  septum.right_side(), "tricuspid_valve");
  builder.add(make_sleeve("superior_vena_cava", {-24, -5, 14}, {-25, -3, 40}, 9), cava_fillet);
  builder.add(make_sleeve("inferior_vena_cava", {-23, 0, -18}, {-24, 8, -37}, 11), cava_fillet);
  builder.add(make_sleeve("coronary_sinus", {-10, -3, -18}, {2, 4, -27}, 5), sinus_fillet);
  const RoundCone upper{Vector(-20, -18, 13), Vector(-4, -42, 19), 11, 4.5};
  const RoundCone lower{Vector(-23, -22, 3), Vector(-4, -42, 19), 11, 4.5};
  const auto appendage = [=](const Vector& point) {
    return smooth_union(sample(upper, point), sample(lower, point), right_appendage_fillet);
  };
  builder.add({"right_atrial_appendage", appendage}, right_appendage_fillet, enclose(bounds(upper), bounds(lower)));
  builder.open("fossa_ovalis", septum.fossa());
  return builder.finish();
}

Chamber make_bachmann_bundle() {
  const double height = 1.5, groove_fillet = 12;
  const auto left = make_left_chamber().function, right = make_right_chamber().function;
  const auto above = [=](const Vector& point) {
    return offset(smooth_union(left(point), right(point), groove_fillet), height);
  };
  const Band band =
      lay_band(above, {{-32, -20, 19}, {-19, -19, 23}, {-5, -10, 18}, {8, -9, 15}, {20, -8, 16}, {31, -5, 18}},
               {4, 5.5, 5.5, 5.5, 5, 3.5});
  Chamber bundle{{{"bachmann_bundle", above}}, above, {}, widen(band.bounds, 4)};
  const auto beside = [band](const Vector& point) { return sample(band, point); };
  const double everywhere = std::numeric_limits<double>::infinity();
  bundle.openings.push_back({"bachmann_bundle_margin", {beside, Vector::Zero(), everywhere}});
  return bundle;
}

}  // namespace pectinate::detail
