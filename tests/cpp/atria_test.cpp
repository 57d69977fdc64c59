// SPDX-License-Identifier: MIT
#include "pectinate/atria.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "detail/atria_anatomy.hpp"
#include "detail/triangle_tree.hpp"
#include "generated_checks.hpp"
#include "pectinate/errors.hpp"
#include "pectinate/surface_mesh.hpp"
#include "triangle_crossings.hpp"

namespace pectinate {
namespace {

using detail::Chamber;
using detail::vector;
using detail::Vector;

constexpr auto left = AtrialSurface::left_atrium, right = AtrialSurface::right_atrium;
constexpr auto bundle = AtrialSurface::bachmann_bundle;
constexpr auto epicardium = AtrialLayer::epicardium, endocardium = AtrialLayer::endocardium;

using Names = std::vector<std::string>;

struct Expected {
  AtrialSurface which;
  AtrialLayer layer;
  Chamber outside;
  Names regions, loops;

  double depth() const { return layer == endocardium ? atrial_wall_thickness : 0; }
  GeneratedSurface make(double edge_length) const { return make_atrial_surface(which, layer, {edge_length}); }
};

std::vector<Expected> all_surfaces() {
  std::vector<Expected> all{
      {bundle, epicardium, detail::make_bachmann_bundle(), {"bachmann_bundle"}, {"bachmann_bundle_margin"}}};
  for (const auto layer : {epicardium, endocardium}) {
    all.push_back({left,
                   layer,
                   detail::make_left_chamber(),
                   {"body", "left_superior_pulmonary_vein", "left_inferior_pulmonary_vein",
                    "right_superior_pulmonary_vein", "right_inferior_pulmonary_vein", "left_atrial_appendage"},
                   {"mitral_valve", "left_superior_pulmonary_vein", "left_inferior_pulmonary_vein",
                    "right_superior_pulmonary_vein", "right_inferior_pulmonary_vein", "fossa_ovalis"}});
    all.push_back({right,
                   layer,
                   detail::make_right_chamber(),
                   {"body", "superior_vena_cava", "inferior_vena_cava", "coronary_sinus", "right_atrial_appendage"},
                   {"tricuspid_valve", "superior_vena_cava", "inferior_vena_cava", "coronary_sinus", "fossa_ovalis"}});
  }
  return all;
}

test::Soup soup(const GeneratedSurface& surface) {
  return {surface.vertices, surface.triangles};
}

Names loop_names(const GeneratedSurface& surface) {
  Names names;
  for (const auto& loop : surface.loops) names.push_back(loop.name);
  return names;
}

void check_on_surface(const GeneratedSurface& surface, const Expected& expected) {
  for (const auto& vertex : surface.vertices) {
    REQUIRE(std::abs(expected.outside.function(vector(vertex)).value + expected.depth()) < 1e-9);
  }
  for (std::size_t i = 0; i < surface.loops.size(); ++i) {
    for (const auto v : surface.loops[i].vertices) {
      REQUIRE(std::abs(expected.outside.openings[i].cut.height(vector(surface.vertices[v]))) < 1e-9);
    }
  }
}

/// Every region is there; a loop borders the region of its name alone, or else the body.
void check_regions(const GeneratedSurface& surface, const Names& names) {
  REQUIRE(surface.region_names == names);
  REQUIRE(surface.regions.size() == surface.triangles.size());
  std::vector<int> counts(names.size(), 0);
  for (const auto region : surface.regions) ++counts.at(region);
  CHECK(*std::min_element(counts.begin(), counts.end()) > 40);
  for (const auto& loop : surface.loops) {
    CAPTURE(loop.name);
    const auto named = std::find(names.begin(), names.end(), loop.name);
    const auto region = named == names.end() ? 0 : named - names.begin();
    std::vector<bool> on_loop(surface.vertices.size(), false);
    for (const auto v : loop.vertices) on_loop[v] = true;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const auto& [a, b, c] = surface.triangles[t];
      if (on_loop[a] || on_loop[b] || on_loop[c]) REQUIRE(surface.regions[t] == region);
    }
  }
}

const NamedLoop& loop_named(const GeneratedSurface& surface, const std::string& name) {
  const auto found =
      std::find_if(surface.loops.begin(), surface.loops.end(), [&](const auto& l) { return l.name == name; });
  REQUIRE(found != surface.loops.end());
  return *found;
}

Vector mean_point(const GeneratedSurface& surface, const std::string& loop) {
  Vector sum = Vector::Zero();
  const auto& vertices = loop_named(surface, loop).vertices;
  for (const auto v : vertices) sum += vector(surface.vertices[v]);
  return sum / static_cast<double>(vertices.size());
}

/// From the mean point to the vertices of a loop: the least and the most.
std::pair<double, double> radii(const GeneratedSurface& surface, const std::string& loop) {
  const Vector centre = mean_point(surface, loop);
  std::vector<double> distances;
  for (const auto v : loop_named(surface, loop).vertices)
    distances.push_back((vector(surface.vertices[v]) - centre).norm());
  const auto [least, most] = std::minmax_element(distances.begin(), distances.end());
  return {*least, *most};
}

/// Of the plane through a loop, as a vector area: outwards where the loop runs counter-clockwise seen from inside.
Vector loop_area(const GeneratedSurface& surface, const std::string& name) {
  const auto& vertices = loop_named(surface, name).vertices;
  const Vector centre = mean_point(surface, name);
  Vector sum = Vector::Zero();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vector a = vector(surface.vertices[vertices[i]]) - centre;
    const Vector b = vector(surface.vertices[vertices[(i + 1) % vertices.size()]]) - centre;
    sum -= a.cross(b) / 2;
  }
  return sum;
}

Vector farthest(const GeneratedSurface& surface, const std::string& region, const Vector& direction) {
  const auto& names = surface.region_names;
  const auto tag = std::find(names.begin(), names.end(), region) - names.begin();
  Vector best = -1e9 * direction;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Vector corner = vector(surface.vertices[surface.triangles[t][0]]);
    if (surface.regions[t] == tag && direction.dot(corner) > direction.dot(best)) best = corner;
  }
  return best;
}

TEST_CASE("each surface of the atria is one piece of good triangles with the loops and regions of its name") {
  for (const auto& expected : all_surfaces()) {
    CAPTURE(static_cast<int>(expected.which));
    CAPTURE(static_cast<int>(expected.layer));
    for (const double edge_length : {2.0, 0.7}) {  // remeshed only, and subdivided
      CAPTURE(edge_length);
      const auto surface = expected.make(edge_length);
      REQUIRE(loop_names(surface) == expected.loops);
      test::check_good_surface(surface, expected.loops.size(), edge_length);
      test::check_loops_are_the_open_sides(surface);
      check_regions(surface, expected.regions);
      check_on_surface(surface, expected);
      CHECK(test::crossing_triangles(soup(surface), edge_length).empty());
    }
  }
}

TEST_CASE("the outsides have about 43,679 triangles at 1 mm") {
  std::size_t count = 0;
  for (const auto which : {left, right, bundle}) count += make_atrial_surface(which, epicardium).triangles.size();
  CHECK(static_cast<double>(count) == doctest::Approx(43679).epsilon(0.03));
}

TEST_CASE("the surfaces do not cross one another") {
  std::vector<Expected> all = all_surfaces();
  test::Soup everything;
  for (const auto& expected : all) everything = test::together(everything, soup(expected.make(2)));
  CHECK(test::crossing_triangles(everything, 2).empty());
}

TEST_CASE("pushed into one another, the surfaces are found to cross") {
  const auto atrium = soup(make_atrial_surface(left, epicardium, {2}));
  auto moved = atrium;
  for (auto& vertex : moved.vertices) vertex[0] += 1;
  CHECK(test::crossing_triangles(test::together(atrium, moved), 2).size() > 100);
  const auto top = std::max_element(atrium.vertices.begin(), atrium.vertices.end(),
                                    [](const Vec3& a, const Vec3& b) { return a[2] < b[2]; });
  auto pierced = atrium;
  pierced.vertices[top - atrium.vertices.begin()] = {10, 10, -60};  // through the cavity and the floor
  CHECK(!test::crossing_triangles(pierced, 2).empty());
}

TEST_CASE("the atria lie apart, and the bundle above both") {
  const auto left_outside = detail::make_left_chamber(), right_outside = detail::make_right_chamber();
  for (const auto layer : {epicardium, endocardium}) {
    for (const auto& v : make_atrial_surface(left, layer, {2}).vertices)
      CHECK(right_outside.function(vector(v)).value > 1);
    for (const auto& v : make_atrial_surface(right, layer, {2}).vertices)
      CHECK(left_outside.function(vector(v)).value > 1);
  }
  for (const auto& v : make_atrial_surface(bundle, epicardium, {1}).vertices) {
    const double height = std::min(left_outside.function(vector(v)).value, right_outside.function(vector(v)).value);
    CHECK(height > 1.5 - 1e-9);
    CHECK(height < 3.6);
  }
}

TEST_CASE("the endocardium lies inside the epicardium, about the wall's thickness away") {
  for (const auto which : {left, right}) {
    const auto outside = make_atrial_surface(which, epicardium, {1.5}),
               inside = make_atrial_surface(which, endocardium, {2});
    const SurfaceMesh mesh(outside.vertices, outside.triangles);
    const detail::TriangleTree tree(mesh);
    std::vector<double> walls;
    for (const auto& vertex : inside.vertices) {
      const auto nearest = tree.nearest(vector(vertex));
      const auto& [a, b, c] = mesh.triangles()[nearest.triangle];
      const auto corner = [&](std::int32_t v) { return Vector(vector(mesh.vertices()[v])); };
      const Vector foot = detail::nearest_in_triangle(vector(vertex), {corner(a), corner(b), corner(c)});
      walls.push_back((vector(vertex) - foot).norm());
    }
    std::sort(walls.begin(), walls.end());
    CHECK(walls.front() > 0.93 * atrial_wall_thickness);
    CHECK(walls[walls.size() / 2] < 1.1 * atrial_wall_thickness);
    CHECK(walls[walls.size() * 95 / 100] < 1.5 * atrial_wall_thickness);
    CHECK(walls.back() < 2.5 * atrial_wall_thickness);  // under a fillet
  }
}

TEST_CASE("the fossa ovalis is an oval hole in both walls, opposite and parallel") {
  for (const auto layer : {epicardium, endocardium}) {
    const auto one = make_atrial_surface(left, layer, {2}), other = make_atrial_surface(right, layer, {2});
    const Vector to_right = loop_area(one, "fossa_ovalis"), to_left = loop_area(other, "fossa_ovalis");
    const Vector between = mean_point(other, "fossa_ovalis") - mean_point(one, "fossa_ovalis");
    CHECK(to_right.normalized().dot(-to_left.normalized()) > std::cos(5 * std::numbers::pi / 180));
    CHECK(to_right.normalized().dot(between) > 1);
    CHECK(to_right.normalized().dot(between) < (layer == epicardium ? 4 : 8));
    CHECK(to_right.normalized().cross(between).norm() < 1);
    CHECK(to_right.norm() == doctest::Approx(to_left.norm()).epsilon(0.02));
    CHECK(radii(one, "fossa_ovalis").first == doctest::Approx(7).epsilon(0.05));
    CHECK(radii(one, "fossa_ovalis").second == doctest::Approx(9).epsilon(0.05));
  }
}

TEST_CASE("vessels and valves have the sizes of a heart, and less inside by the wall") {
  const std::map<std::string, double> expected{{"left_superior_pulmonary_vein", 6.5},
                                               {"left_inferior_pulmonary_vein", 6},
                                               {"right_superior_pulmonary_vein", 6.5},
                                               {"right_inferior_pulmonary_vein", 6},
                                               {"superior_vena_cava", 9},
                                               {"inferior_vena_cava", 11},
                                               {"coronary_sinus", 5},
                                               {"mitral_valve", 17},
                                               {"tricuspid_valve", 19.5}};
  for (const auto which : {left, right}) {
    for (const auto layer : {epicardium, endocardium}) {
      const auto surface = make_atrial_surface(which, layer, {2});
      for (const auto& loop : surface.loops) {
        if (!expected.contains(loop.name)) continue;
        const double radius = expected.at(loop.name) - (layer == endocardium ? atrial_wall_thickness : 0);
        CAPTURE(loop.name);
        CHECK(radii(surface, loop.name).first > 0.85 * radius);
        CHECK(radii(surface, loop.name).second < 1.1 * radius + 0.3);
      }
    }
  }
}

TEST_CASE("every structure lies where anatomy has it") {
  const auto l = make_atrial_surface(left, epicardium, {2}), r = make_atrial_surface(right, epicardium, {2});
  const auto b = make_atrial_surface(bundle, epicardium, {2});
  const auto vein = [&](const std::string& name) { return mean_point(l, name + "_pulmonary_vein"); };
  const Vector svc = mean_point(r, "superior_vena_cava"), ivc = mean_point(r, "inferior_vena_cava");
  const Vector mitral = mean_point(l, "mitral_valve"), tricuspid = mean_point(r, "tricuspid_valve");
  const Vector sinus = mean_point(r, "coronary_sinus");
  for (const std::string side : {"left", "right"}) {
    CHECK(vein(side + "_superior").z() > vein(side + "_inferior").z() + 20);
    CHECK(vein(side + "_superior").y() > mitral.y() + 20);  // posterior
    CHECK(vein(side + "_inferior").y() > vein(side + "_superior").y());
  }
  CHECK(vein("left_superior").x() > vein("right_superior").x() + 50);
  CHECK(vein("left_inferior").x() > vein("right_inferior").x() + 50);
  CHECK(vein("right_superior").y() > svc.y() + 15);  // behind the vena cava
  CHECK(svc.z() > ivc.z() + 60);
  CHECK(std::abs(svc.x() - ivc.x()) < 10);
  CHECK(mitral.x() > tricuspid.x() + 20);
  CHECK(tricuspid.y() < mitral.y());
  CHECK((sinus - ivc).norm() > 16.5);  // between the vein and the valve
  CHECK(sinus.x() > ivc.x());
  CHECK(sinus.y() > tricuspid.y());
  CHECK(sinus.z() < svc.z());
  for (const Vector& faced : {loop_area(l, "mitral_valve"), loop_area(r, "tricuspid_valve")}) {
    CHECK(faced.x() > 0);  // to the left, the front and below
    CHECK(faced.y() < 0);
    CHECK(faced.z() < 0);
  }
  const Vector forwards(0, -1, 0);
  const Vector left_tip = farthest(l, "left_atrial_appendage", forwards);
  const Vector right_tip = farthest(r, "right_atrial_appendage", forwards);
  CHECK(left_tip.y() < mitral.y() - 15);
  CHECK(left_tip.z() > mitral.z() + 15);
  CHECK(right_tip.y() < tricuspid.y() - 15);
  CHECK(right_tip.z() > tricuspid.z() + 25);
  CHECK(right_tip.x() > svc.x() + 15);  // to the left, over the root of the aorta
  const Vector right_end = farthest(b, "bachmann_bundle", -Vector::UnitX());
  const Vector left_end = farthest(b, "bachmann_bundle", Vector::UnitX());
  CHECK(right_end.x() < svc.x());
  CHECK(left_end.x() > 25);
  CHECK(left_end.y() < vein("left_superior").y() - 15);
}

TEST_CASE("an atrial surface is the same every time") {
  for (const auto& expected : all_surfaces()) {
    const auto one = expected.make(2), other = expected.make(2);
    CHECK(one.vertices == other.vertices);
    CHECK(one.triangles == other.triangles);
    CHECK(one.regions == other.regions);
    for (std::size_t i = 0; i < one.loops.size(); ++i) CHECK(one.loops[i].vertices == other.loops[i].vertices);
  }
}

TEST_CASE("an atrial surface that cannot be is refused") {
  for (const double edge_length :
       {0.099, 2.1, -1.0, 0.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    CHECK_THROWS_AS(make_atrial_surface(left, epicardium, {edge_length}), InvalidOption);
  }
  CHECK_THROWS_AS(make_atrial_surface(bundle, endocardium), InvalidOption);
  CHECK_THROWS_AS(make_atrial_surface(static_cast<AtrialSurface>(7), epicardium), InvalidOption);
  CHECK_THROWS_AS(make_atrial_surface(left, static_cast<AtrialLayer>(-1)), InvalidOption);
}

}  // namespace
}  // namespace pectinate
