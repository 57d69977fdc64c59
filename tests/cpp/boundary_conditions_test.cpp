// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "pectinate/constraints.hpp"
#include "pectinate/errors.hpp"
#include "tracts.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;
using detail::vector;
using enum BoundaryRule;
using Tracts = std::vector<Tract>;
using Conditions = std::vector<BoundaryCondition>;

constexpr double degree = std::numbers::pi / 180;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("boundary: on a regular loop fibres are parallel to the circle, or perpendicular") {
  for (const int around : {3, 4, 5, 24}) {
    for (const auto rule : {parallel, perpendicular}) {
      for (const auto& soup : {ring(around, 2), cylinder(around, 2, 1, 2)}) {
        const auto mesh = soup.mesh();
        const auto constraints = make_constraints(mesh, {}, Conditions{{0, rule, 0.5}, {1, rule, hard}});
        check_constraints(mesh, constraints);
        CHECK(constraints.conflicts.empty());
        REQUIRE(constraints.triangles.size() == 2 * around);
        for (const auto& [t, direction, weight, index] : constraints.triangles) {
          int side = 0;
          while (mesh.neighbour(t, side).triangle >= 0) ++side;
          const double angle = line_angle(vector(direction), corner(mesh, t, side + 1) - corner(mesh, t, side));
          CHECK(std::abs(angle - (rule == parallel ? 0 : 90 * degree)) < 1e-12);
          CHECK(index == -1);
        }
      }
    }
  }
}

TEST_CASE("boundary: a jagged loop turns fibres far less than its edges") {
  // A band whose lower border is a staircase of right angles along a line at 45 degrees.
  const Soup all = grid(30, 30);
  Soup stairs{all.vertices, {}};
  for (const auto& t : all.triangles) {
    const Vector c = (vector(all.vertices[t[0]]) + vector(all.vertices[t[1]]) + vector(all.vertices[t[2]])) / 3;
    if (std::floor(c.y()) >= std::floor(c.x())) stairs.triangles.push_back(t);
  }
  const auto jagged = stairs.mesh();
  const auto constraints = make_constraints(jagged, {}, Conditions{{0, parallel}});
  int checked = 0;
  for (const auto& constraint : constraints.triangles) {
    const Vector c = centre(jagged, constraint.triangle);
    if (std::abs(c.x() - c.y()) > 1 || c.x() < 4 || c.x() > 26) continue;
    CHECK(line_angle(vector(constraint.direction), Vector(1, 1, 0)) < 1e-12);
    ++checked;
  }
  CHECK(checked >= 20);
}

TEST_CASE("boundary: ears follow the loop, a lone triangle follows nothing") {
  // The tip of triangle 0, (0, 0), has two sides on the loop.
  const auto mesh = grid(1, 1).mesh();
  const auto constraints = make_constraints(mesh, {}, Conditions{{0, parallel}});
  CHECK(constrained_triangles(constraints) == std::vector{0, 1});
  for (const auto& c : constraints.triangles) CHECK(line_angle(vector(c.direction), Vector(1, 1, 0)) < 1e-12);
  CHECK(make_constraints(one_triangle().mesh(), {}, Conditions{{0, parallel}}).triangles.empty());
}

TEST_CASE("boundary: free loops and loops without a condition ask for nothing") {
  const auto mesh = ring(12, 2).mesh();
  CHECK(make_constraints(mesh, {}, {}).triangles.empty());
  CHECK(make_constraints(mesh, {}, Conditions{{0, free}, {1, free}}).triangles.empty());
  CHECK(make_constraints(mesh, {}, Conditions{{1, perpendicular}}).triangles.size() == 12);
}

TEST_CASE("boundary: a hard tract is met exactly, also where the boundary nearly agrees") {
  const auto mesh = ring(12, 4).mesh();
  const auto across = tract({{0.985, 0.28, 0}, {1.8, 0.28, 0}});
  const auto constraints = make_constraints(mesh, Tracts{across}, Conditions{{1, perpendicular, hard}});
  CHECK(constraints.conflicts.empty());
  for (const auto& constraint : constraints.triangles) {
    if (constraint.tract < 0) continue;
    CHECK(line_angle(vector(constraint.direction), Vector(1, 0, 0)) < 1e-12);
  }
}

TEST_CASE("boundary: any tract prevails over it, or is averaged with it") {
  const auto mesh = ring(12, 4).mesh();
  // Across the inner loop, which is the shorter one.
  const auto across = tract({{0.985, 0.28, 0}, {1.8, 0.28, 0}}, 2);
  for (const double weight : {0.1, 1.0, hard}) {
    const auto constraints = make_constraints(mesh, Tracts{across}, Conditions{{1, parallel, weight}});
    check_constraints(mesh, constraints);
    REQUIRE(constraints.conflicts.size() == 1);
    const auto& [triangle, kept, dropped, angle] = constraints.conflicts[0];
    CHECK(kept == 0);
    CHECK(dropped == -1);
    CHECK(angle > 60 * degree);
    const auto constraint = constraint_of(constraints, triangle);
    CHECK(line_angle(vector(constraint.direction), Vector(1, 0, 0)) < 1e-12);
    CHECK(constraint.weight == 2);
    CHECK(constraint.tract == 0);
  }
  const auto along = make_constraints(mesh, Tracts{across}, Conditions{{1, perpendicular, 2}});
  CHECK(along.conflicts.empty());
  const auto shared = std::find_if(along.triangles.begin(), along.triangles.end(),
                                   [](const TriangleConstraint& c) { return c.weight == 4; });
  REQUIRE(shared != along.triangles.end());
  CHECK(shared->tract == 0);
  // Halfway between the tract and the radius through the middle of the edge.
  CHECK(line_angle(vector(shared->direction), Vector(std::cos(7.5 * degree), std::sin(7.5 * degree), 0)) < 1e-12);
}

TEST_CASE("the boundary loop and the surface point nearest to a point") {
  const auto mesh = cylinder(20, 5, 1, 3).mesh();
  for (const std::int32_t loop : {0, 1}) {
    const double z = mesh.boundary_loops()[loop].centroid[2];
    CHECK(nearest_boundary_loop(mesh, {0.5, 0.5, z + (z > 1 ? -1.4 : 1.4)}) == loop);
    CHECK(nearest_boundary_loop(mesh, {0, 0, z > 1 ? 1e6 : -1e6}) == loop);
  }
  // By the distance to edges, not to vertices.
  const auto sparse = together(mapped(grid(1, 1), [](const Vector& v) { return Vector(20 * v.x(), v.y(), 0); }),
                               moved(grid(1, 1), {9, 3, 0}))
                          .mesh();
  CHECK(nearest_boundary_loop(sparse, {10, 1.9, 0}) == 0);
  CHECK(nearest_boundary_loop(sparse, {10, 2.1, 0}) == 1);
  CHECK_THROWS_WITH_AS(nearest_surface_points(mesh, std::vector<Vec3>{{0, 0, 0}, {0, 1e11, 0}}),
                       doctest::Contains("point 1 is not finite, or farther away"), InvalidOption);
  CHECK_THROWS_AS(nearest_surface_points(mesh, std::vector<Vec3>{{0, nan, 0}}), InvalidOption);
  CHECK_THROWS_AS(nearest_boundary_loop(sphere(1).mesh(), {0, 0, 0}), InvalidMesh);
  CHECK_THROWS_AS(nearest_boundary_loop(mesh, {0, nan, 0}), InvalidOption);
}

}  // namespace pectinate::test
