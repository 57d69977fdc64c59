// SPDX-License-Identifier: MIT
#include "pectinate/constraints.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>

#include "pectinate/errors.hpp"
#include "tracts.hpp"

namespace pectinate::test {
namespace {

using detail::vec3;
using detail::Vector;
using detail::vector;
using enum BoundaryRule;
using Tracts = std::vector<Tract>;
using Conditions = std::vector<BoundaryCondition>;

constexpr double degree = std::numbers::pi / 180;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A tract through the middle of triangle 8 of grid(3, 3), inside it, at an angle from the x axis.
Tract through_triangle(double angle, double weight = hard) {
  const Vector middle(5.0 / 3, 4.0 / 3, 0), half = 0.05 * Vector(std::cos(angle), std::sin(angle), 0);
  return tract({vec3(middle - half), vec3(middle + half)}, weight);
}

/// What tracts through one triangle make of it.
Constraints through_one(const Tracts& tracts, double conflict_angle = 30 * degree) {
  static const auto mesh = grid(3, 3).mesh();
  auto constraints = make_constraints(mesh, tracts, {}, {std::nullopt, conflict_angle});
  REQUIRE(constraints.triangles.size() == 1);
  REQUIRE(constraints.triangles[0].triangle == 8);
  return constraints;
}

double angle_of(const TriangleConstraint& constraint) {
  const double angle = std::atan2(constraint.direction[1], constraint.direction[0]);
  return angle - std::numbers::pi * std::round(angle / std::numbers::pi);
}

Tracts random_tracts(const SurfaceMesh& mesh, int count, std::uint64_t seed) {
  Random random(seed);
  Tracts tracts;
  for (int i = 0; i < count; ++i) {
    std::vector<Vec3> points(4);
    for (auto& point : points) point = vec3(random_place(mesh, random));
    tracts.push_back(tract(points, i % 3 == 0 ? hard : 1 + random.unit()));
  }
  return tracts;
}

}  // namespace

TEST_CASE("constraints: in a plane each triangle gets the direction of the tract") {
  Random random(1);
  const auto mesh = jittered_grid(12, 12).mesh();
  for (int i = 0; i < 30; ++i) {
    const Vec3 a{12 * random.unit(), 12 * random.unit(), 0}, b{12 * random.unit(), 12 * random.unit(), 0};
    const auto constraints = make_constraints(mesh, Tracts{tract({a, b}, 2.5)}, {});
    check_constraints(mesh, constraints);
    CHECK(constraints.conflicts.empty());
    for (const auto& constraint : constraints.triangles) {
      CHECK(line_angle(vector(constraint.direction), vector(b) - vector(a)) < 1e-12);
      CHECK(constraint.weight == 2.5);
      CHECK(constraint.tract == 0);
    }
  }
}

TEST_CASE("constraints: a corner that is clipped by a millionth of an edge is constrained, by a trillionth is not") {
  const auto mesh = grid(4, 4).mesh();
  const auto clipping = [&](double by) {
    const auto constraints = make_constraints(mesh, Tracts{tract({{0.5, 2.5 + by, 0}, {2.5 + by, 0.5, 0}})}, {});
    for (const auto& c : constraints.triangles) CHECK(line_angle(vector(c.direction), Vector(1, -1, 0)) < 1e-9);
    return constrained_triangles(constraints);
  };
  // The line x + y = 3 + by passes the vertices (1, 2) and (2, 1); above them, six triangles more or fewer.
  const auto exact = clipping(1e-12), above = clipping(1e-6), below = clipping(-1e-6);
  CHECK(exact.size() < above.size());
  CHECK(exact.size() < below.size());
  CHECK(above == clipping(1e-3));
  CHECK(below == clipping(-1e-3));
}

TEST_CASE("constraints: several segments in a triangle are averaged as lines, by length") {
  const auto mesh = grid(3, 3).mesh();
  const Vec3 a{1.5, 1.3, 0}, b{1.7, 1.3, 0}, c{1.7 + 0.1 * std::cos(1.0), 1.3 + 0.1 * std::sin(1.0), 0};
  const std::complex<double> sum = 0.2 + 0.1 * std::polar(1.0, 2.0);
  const auto constraints = make_constraints(mesh, Tracts{tract({a, b, c})}, {});
  REQUIRE(constraints.triangles.size() == 1);
  CHECK(angle_of(constraints.triangles[0]) == doctest::Approx(std::arg(sum) / 2).epsilon(1e-12));
  CHECK(constraints.conflicts.empty());
}

TEST_CASE("constraints: a right angle in a triangle is cut short, and evenly around still is a direction") {
  const auto mesh = grid(3, 3).mesh();
  const Vec3 a{1.5, 1.2, 0}, b{1.7, 1.2, 0}, c{1.7, 1.4, 0};
  const auto corner = make_constraints(mesh, Tracts{tract({a, b, c})}, {});
  CHECK(line_angle(vector(constraint_of(corner, 8).direction), Vector(1, 1, 0)) < 1e-12);
  const auto around = make_constraints(
      mesh, Tracts{tract({{1.7, 1.2, 0}, {1.8, 1.2, 0}, {1.8, 1.3, 0}, {1.7, 1.3, 0}, {1.7, 1.2, 0}})}, {});
  check_constraints(mesh, around);
  CHECK(constrained_triangles(around) == std::vector{8});
}

TEST_CASE("constraints: a closed tract has no corner where it starts") {
  const auto mesh = jittered_grid(10, 10).mesh();
  std::vector<Vec3> circle(40);
  for (int i = 0; i < 40; ++i) circle[i] = {5 + 3 * std::cos(turn(i, 40)), 5 + 3 * std::sin(turn(i, 40)), 0};
  auto closed = [&](int start) {
    auto points = circle;
    std::rotate(points.begin(), points.begin() + start, points.end());
    points.push_back(points.front());
    return make_constraints(mesh, Tracts{tract(points)}, {});
  };
  const auto reference = closed(0);
  CHECK(reference.conflicts.empty());
  for (const int start : {1, 7, 20, 33}) {
    const auto other = closed(start);
    CHECK(constrained_triangles(other) == constrained_triangles(reference));
    for (std::size_t i = 0; i < reference.triangles.size(); ++i) {
      CHECK(line_angle(vector(other.triangles[i].direction), vector(reference.triangles[i].direction)) < 1e-12);
    }
  }
}

TEST_CASE("constraints: demands that agree are averaged by their weights, hard ones over weighted ones") {
  const double half = 10 * degree;
  const auto equal = through_one({through_triangle(0), through_triangle(2 * half)}).triangles[0];
  CHECK(angle_of(equal) == doctest::Approx(half).epsilon(1e-12));
  CHECK(equal.weight == hard);
  CHECK(equal.tract == 0);

  const auto weighted = through_one({through_triangle(0, 3), through_triangle(2 * half, 1)}).triangles[0];
  CHECK(angle_of(weighted) == doctest::Approx(std::arg(3.0 + std::polar(1.0, 4 * half)) / 2).epsilon(1e-12));
  CHECK(weighted.weight == 4);

  for (const bool hard_first : {true, false}) {
    Tracts tracts{through_triangle(2 * half), through_triangle(0, 1e3)};
    if (!hard_first) std::swap(tracts[0], tracts[1]);
    const auto mixed = through_one(tracts);
    CHECK(mixed.conflicts.empty());
    CHECK(angle_of(mixed.triangles[0]) == doctest::Approx(2 * half).epsilon(1e-12));
    CHECK(mixed.triangles[0].weight == hard);
    CHECK(mixed.triangles[0].tract == (hard_first ? 0 : 1));
  }
}

TEST_CASE("constraints: of demands that contradict each other the first listed prevails") {
  const auto check_first = [](const Tracts& tracts, double angle) {
    const auto constraints = through_one(tracts);
    CHECK(angle_of(constraints.triangles[0]) == doctest::Approx(0).epsilon(1e-12));
    CHECK(constraints.triangles[0].weight == tracts[0].weight);
    REQUIRE(constraints.conflicts.size() == 1);
    const auto& conflict = constraints.conflicts[0];
    CHECK(conflict.triangle == 8);
    CHECK(conflict.kept == 0);
    CHECK(conflict.dropped == 1);
    CHECK(conflict.angle == doctest::Approx(angle).epsilon(1e-12));
  };
  check_first({through_triangle(0), through_triangle(40 * degree)}, 40 * degree);
  check_first({through_triangle(0), through_triangle(140 * degree)}, 40 * degree);
  check_first({through_triangle(0, 1), through_triangle(90 * degree)}, 90 * degree);  // though the second is hard

  // The limit is the option's.
  const Tracts apart{through_triangle(0), through_triangle(40 * degree)};
  CHECK(through_one(apart, 41 * degree).conflicts.empty());
  CHECK(through_one(apart, 39 * degree).conflicts.size() == 1);
  CHECK(through_one({through_triangle(0), through_triangle(90 * degree)}, 90 * degree).conflicts.empty());

  // A third is measured against each that is kept, not against their average.
  const auto fan = through_one({through_triangle(0), through_triangle(25 * degree), through_triangle(50 * degree)});
  CHECK(angle_of(fan.triangles[0]) == doctest::Approx(12.5 * degree).epsilon(1e-12));
  REQUIRE(fan.conflicts.size() == 1);
  CHECK(fan.conflicts[0].dropped == 2);
}

TEST_CASE("constraints: a tract that crosses itself keeps its longest passage") {
  const auto mesh = grid(6, 6).mesh();
  const Vec3 crossing{2.9, 2.3, 0};  // where it is 0.7 long to the right and 0.9 upwards
  const std::vector<Vec3> points{{0.7, 2.3, 0}, {4.7, 2.3, 0}, {4.7, 4.3, 0}, {2.9, 4.3, 0}, {2.9, 0.3, 0}};
  const auto t = nearest_surface_points(mesh, std::vector{crossing})[0].triangle;
  for (const auto& drawn : {tract(points), backwards(tract(points))}) {
    const auto constraints = make_constraints(mesh, Tracts{tract({{0.7, 1.3, 0}, {0.8, 1.3, 0}}), drawn}, {});
    CHECK(line_angle(vector(constraint_of(constraints, t).direction), Vector(0, 1, 0)) < 1e-12);
    REQUIRE(!constraints.conflicts.empty());
    for (const auto& conflict : constraints.conflicts) {
      CHECK(conflict.kept == 1);
      CHECK(conflict.dropped == 1);
      CHECK(conflict.angle == doctest::Approx(90 * degree).epsilon(1e-12));
    }
  }
}

TEST_CASE("constraints: reversing tracts and changing their order changes nothing where none contradict") {
  for (const auto& soup : {jittered_grid(10, 10), sphere(3), torus(30, 12), moebius_strip(30, 4)}) {
    const auto mesh = soup.mesh();
    const auto tracts = random_tracts(mesh, 7, 5);
    const ConstraintOptions all{std::nullopt, std::numbers::pi / 2};  // nothing is a contradiction
    const auto reference = make_constraints(mesh, tracts, {}, all);
    check_constraints(mesh, reference);
    CHECK(reference.conflicts.empty());
    Tracts others;
    for (const std::size_t i : {3, 6, 1, 0, 4, 2, 5}) others.push_back(backwards(tracts[i]));
    const auto changed = make_constraints(mesh, others, {}, all);
    REQUIRE(constrained_triangles(changed) == constrained_triangles(reference));
    for (std::size_t i = 0; i < reference.triangles.size(); ++i) {
      const auto &a = reference.triangles[i], &b = changed.triangles[i];
      CHECK(line_angle(vector(a.direction), vector(b.direction)) < 1e-10);
      CHECK((a.weight == b.weight || std::abs(a.weight - b.weight) < 1e-12));
    }
  }
}

TEST_CASE("constraints: whatever tracts are drawn, triangles and conflicts are in order") {
  const auto mesh = torus(30, 12).mesh();
  const auto constraints = make_constraints(mesh, random_tracts(mesh, 12, 3), {});
  check_constraints(mesh, constraints);
  const auto own = [](const ConstraintConflict& conflict) { return conflict.kept == conflict.dropped; };
  CHECK(std::ranges::any_of(constraints.conflicts, own));
  CHECK_FALSE(std::ranges::all_of(constraints.conflicts, own));
}

TEST_CASE("constraints: turning everything turns the result") {
  const auto rotation = some_rotation();
  const auto turned = [&](const Vector& v) { return Vector(rotation * v); };
  // Uneven surfaces: where two ways are equally long, rounding chooses.
  const auto uneven = [](const Vector& v) {
    return Vector(v.x() + 0.1 * std::sin(v.y() + 2 * v.z()), v.y() + 0.1 * v.x() * v.x(), v.z() + 0.07 * v.x() * v.y());
  };
  for (const auto& plain : {jittered_grid(10, 10), sphere(3), torus(30, 12), cylinder(20, 9, 1, 2)}) {
    const auto soup = mapped(plain, uneven);
    const auto mesh = soup.mesh();
    const auto turned_mesh = mapped(soup, turned).mesh();
    Random random(8);
    Tracts tracts, turned_tracts;
    for (int i = 0; i < 12; ++i) {
      std::vector<Vec3> points, turned_points;
      for (int k = 0; k < 4; ++k) {
        // Inside triangles: a point on an edge may come to either side of it.
        const auto t = static_cast<std::int32_t>(random.below(mesh.triangle_count()));
        const double u = 0.1 + 0.4 * random.unit(), v = 0.1 + 0.35 * random.unit();
        const Vector place = u * corner(mesh, t, 0) + v * corner(mesh, t, 1) + (1 - u - v) * corner(mesh, t, 2);
        points.push_back(vec3(place));
        turned_points.push_back(vec3(turned(place)));
      }
      tracts.push_back(tract(points));
      turned_tracts.push_back(tract(turned_points));
    }
    Conditions conditions;
    for (std::size_t l = 0; l < mesh.boundary_loops().size(); ++l) {
      conditions.push_back({static_cast<std::int32_t>(l), l % 2 ? perpendicular : parallel});
    }
    const auto before = make_constraints(mesh, tracts, conditions);
    const auto after = make_constraints(turned_mesh, turned_tracts, conditions);
    REQUIRE(constrained_triangles(before) == constrained_triangles(after));
    CHECK(before.conflicts.size() == after.conflicts.size());
    for (std::size_t i = 0; i < before.triangles.size(); ++i) {
      const Vector expected = rotation * vector(before.triangles[i].direction);
      CHECK(line_angle(expected, vector(after.triangles[i].direction)) < 1e-9);
    }
  }
}

TEST_CASE("constraints: errors name what is wrong") {
  const auto mesh = ring(12, 2).mesh();
  const auto message = [&](const Tracts& tracts, const Conditions& conditions, const ConstraintOptions& options) {
    try {
      make_constraints(mesh, tracts, conditions, options);
    } catch (const InvalidOption& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto good = tract({{1.1, 0, 0}, {1.9, 0, 0}});
  CHECK(message({good}, {{0, parallel}}, {}).empty());
  for (const double weight : {least_weight, greatest_weight, hard}) {
    CHECK(message({tract(good.points, weight)}, {{0, parallel, weight}}, {}).empty());
  }
  for (const double bad : {0.0, -1.0, nan, -infinity, 0.999 * least_weight, 1.001 * greatest_weight}) {
    CHECK(message({good, {"septal", good.points, bad}}, {}, {}).starts_with("tract 1 \"septal\" has the weight"));
    CHECK(message({}, {{0, free, bad}}, {}).starts_with("boundary condition 0 has the weight"));
  }
  for (const std::int32_t bad : {-1, 2, std::numeric_limits<std::int32_t>::max()}) {
    CHECK(message({}, {{1, free}, {bad, free}}, {}) == "boundary condition 1 is for loop " + std::to_string(bad) +
                                                           ", but the mesh has 2 boundary loops, numbered from 0");
  }
  CHECK(
      message({}, {{1, free}, {0, free}, {1, parallel}}, {}).starts_with("boundary condition 2 is for loop 1, which"));
  CHECK(message({}, {{0, static_cast<BoundaryRule>(7)}}, {}).find("no known rule") != std::string::npos);
  for (const double bad : {0.0, -0.1, 1.58, nan, infinity}) {
    CHECK(message({good}, {}, {std::nullopt, bad}).starts_with("conflict_angle is "));
  }
  for (const double bad : {0.0, -0.1, nan, -infinity}) {
    CHECK(message({good}, {}, {bad}).starts_with("maximum_distance is "));
  }
  // By default a hundredth of the diagonal, here sqrt(32) less a little.
  const auto above = [&](double z) { return tract({{1.1, 0, z}, {1.9, 0, z}}); };
  const double limit = 0.01 * mesh.bounding_box_diagonal();
  CHECK(message({above(0.999 * limit)}, {}, {}).empty());
  CHECK(message({above(1.001 * limit)}, {}, {}).starts_with("tract 0: point 0 is "));
  CHECK(message({above(1)}, {}, {1.001}).empty());
  CHECK(message({above(1e6)}, {}, {infinity}).empty());
}

TEST_CASE("constraints: messages name a tract by the number that its caller knows, and say huge numbers shortly") {
  const auto mesh = ring(12, 2).mesh();
  const auto message = [&](const Tract& tract) {
    try {
      make_constraints(mesh, std::vector{tract}, {});
    } catch (const InvalidOption& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const Tract high{"", {{1.1, 0, 1e300}, {1.9, 0, 1e300}}, hard, 7};
  CHECK(message(high).starts_with("tract 7: point 0 is 1e+300 away from the surface, but may be 0.056"));
  CHECK(message({"roof", high.points, hard, 7}).starts_with("tract 7 \"roof\": "));
  CHECK(message(tract(high.points, 1e300)).starts_with("tract 0 has the weight 1e+300, but weights are from 1e-6"));
}

TEST_CASE("constraints: weights that add up stay in their range") {
  const auto summed = through_one({through_triangle(0, greatest_weight), through_triangle(0.1, greatest_weight)});
  CHECK(summed.triangles[0].weight == greatest_weight);
  CHECK(angle_of(summed.triangles[0]) == doctest::Approx(0.05));
}

TEST_CASE("constraints: a projector gives what the functions give") {
  const auto mesh = torus(30, 12).mesh();
  const auto tracts = random_tracts(mesh, 5, 9);
  TractProjector projector(mesh);
  const TractProjector kept = std::move(projector);
  for (int repetition = 0; repetition < 2; ++repetition) {
    const auto one = kept.make_constraints(tracts, {}), other = make_constraints(mesh, tracts, {});
    REQUIRE(one.triangles.size() == other.triangles.size());
    for (std::size_t i = 0; i < one.triangles.size(); ++i) {
      CHECK(one.triangles[i].triangle == other.triangles[i].triangle);
      CHECK(one.triangles[i].direction == other.triangles[i].direction);
    }
    CHECK(one.conflicts.size() == other.conflicts.size());
  }
}

}  // namespace pectinate::test
