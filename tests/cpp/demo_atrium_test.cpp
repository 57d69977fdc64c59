// SPDX-License-Identifier: MIT
#include "pectinate/demo_atrium.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "detail/left_atrium.hpp"
#include "detail/vec.hpp"
#include "generated_checks.hpp"
#include "pectinate/errors.hpp"
#include "pectinate/surface_mesh.hpp"

namespace pectinate {
namespace {

using detail::vector;
using detail::Vector;

Vector corner(const DemoAtrium& atrium, std::size_t t, int k) {
  return vector(atrium.vertices[atrium.triangles[t][k % 3]]);
}

TEST_CASE("the demo atrium is one surface with five openings, wound outwards, of good triangles") {
  for (const double edge_length : {4.0, 2.0, 0.7}) {
    CAPTURE(edge_length);
    test::check_good_surface(make_demo_atrium({edge_length}), 5, edge_length);
  }
}

TEST_CASE("at 1 mm the demo atrium has about 43,000 triangles") {
  const auto count = make_demo_atrium().triangles.size();
  CHECK(count > 40000);
  CHECK(count < 46000);
}

TEST_CASE("vertices lie on the implicit surface, those of the loops on their planes as well") {
  const auto parts = detail::make_left_atrium();
  const auto surface = detail::make_surface(parts);
  for (const double edge_length : {2.0, 0.7}) {
    const auto atrium = make_demo_atrium({edge_length});
    for (const auto& vertex : atrium.vertices) CHECK(std::abs(surface.function(vector(vertex)).value) < 1e-6);
    REQUIRE(atrium.loops.size() == surface.cuts.size());
    const SurfaceMesh mesh(atrium.vertices, atrium.triangles);
    for (std::size_t i = 0; i < atrium.loops.size(); ++i) {
      for (const auto v : atrium.loops[i].vertices) {
        CHECK(std::abs(surface.cuts[i].height(vector(atrium.vertices[v]))) < 1e-9);
      }
      auto named = atrium.loops[i].vertices;
      std::sort(named.begin(), named.end());
      const auto& loops = mesh.boundary_loops();
      CHECK(std::any_of(loops.begin(), loops.end(), [&](const auto& loop) {
        auto found = loop.vertices;
        std::sort(found.begin(), found.end());
        return found == named;
      }));
    }
  }
}

TEST_CASE("the directions are unit and tangent, parallel to the openings, and smooth") {
  const auto atrium = make_demo_atrium();
  const SurfaceMesh mesh(atrium.vertices, atrium.triangles);
  std::vector<double> turns;
  double sine_sum = 0;
  int border_sides = 0;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    const Vector direction = vector(atrium.directions[t]), normal = vector(mesh.triangle_normals()[t]);
    CHECK(direction.norm() == doctest::Approx(1).epsilon(1e-12));
    CHECK(std::abs(direction.dot(normal)) < 1e-12);
    for (int k = 0; k < 3; ++k) {
      const auto other = mesh.neighbour(t, k).triangle;
      if (other < 0) {
        const Vector side = (corner(atrium, t, k + 1) - corner(atrium, t, k)).normalized();
        sine_sum += side.cross(direction).norm();
        ++border_sides;
      } else if (t < other) {
        const double cosine = std::abs(direction.dot(vector(atrium.directions[other])));
        turns.push_back(std::acos(std::min(1.0, cosine)) * 180 / std::numbers::pi);
      }
    }
  }
  std::sort(turns.begin(), turns.end());
  CHECK(turns[turns.size() / 2] < 3);
  CHECK(turns[turns.size() * 99 / 100] < 15);
  CHECK(sine_sum / border_sides < std::sin(10 * std::numbers::pi / 180));
}

TEST_CASE("consecutive vertices of the loops are the open sides of the surface, which lies on their left") {
  for (const double edge_length : {4.0, 0.7}) {  // remeshed only, and subdivided
    test::check_loops_are_the_open_sides(make_demo_atrium({edge_length}));
  }
}

TEST_CASE("every region is there and every triangle is in one") {
  const auto atrium = make_demo_atrium({2});
  REQUIRE(atrium.region_names.size() == 6);
  std::vector<int> counts(6, 0);
  for (const auto region : atrium.regions) ++counts.at(region);
  CHECK(atrium.regions.size() == atrium.triangles.size());
  CHECK(*std::min_element(counts.begin(), counts.end()) > 100);
}

TEST_CASE("the demo atrium is the same every time") {
  const auto one = make_demo_atrium({2}), other = make_demo_atrium({2});
  CHECK(one.vertices == other.vertices);
  CHECK(one.triangles == other.triangles);
  CHECK(one.directions == other.directions);
  CHECK(one.regions == other.regions);
}

TEST_CASE("an edge length out of range is refused") {
  for (const double edge_length : {0.19, 4.1, -1.0, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
    CHECK_THROWS_AS(make_demo_atrium({edge_length}), InvalidOption);
  }
}

}  // namespace
}  // namespace pectinate
