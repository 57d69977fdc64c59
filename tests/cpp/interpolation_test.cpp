// SPDX-License-Identifier: MIT
#include "pectinate/interpolation.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "fields.hpp"
#include "pectinate/demo_atrium.hpp"
#include "pectinate/errors.hpp"
#include "pectinate/field_topology.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;
using detail::vector;
using Rows = std::vector<TriangleConstraint>;
using std::numbers::pi;

std::int32_t count_of(const SurfaceMesh& mesh) {
  return static_cast<std::int32_t>(mesh.triangle_count());
}

TriangleConstraint held(const SurfaceMesh& mesh, std::int32_t t, const Vector& direction, double weight = hard) {
  const Vector normal = vector(mesh.triangle_normals()[t]);
  return {t, detail::vec3((direction - direction.dot(normal) * normal).normalized()), weight, 0};
}

/// Every triangle at the border, in the direction that `function(centre)` gives.
template <class Function>
Rows at_border(const SurfaceMesh& mesh, const Function& function) {
  Rows rows;
  for (std::int32_t t = 0; t < count_of(mesh); ++t) {
    for (int side = 0; side < 3; ++side) {
      if (mesh.neighbour(t, side).triangle >= 0) continue;
      rows.push_back(held(mesh, t, function(centre(mesh, t))));
      break;
    }
  }
  return rows;
}

/// About `count` triangles, in random directions.
Rows random_rows(const SurfaceMesh& mesh, std::uint64_t count, Random& random, double weight = hard) {
  Rows rows;
  for (std::int32_t t = 0; t < count_of(mesh); ++t) {
    if (random.below(mesh.triangle_count()) >= count) continue;
    rows.push_back(held(mesh, t, Vector(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5), weight));
  }
  return rows;
}

/// The greatest angle to the lines that `function(centre, normal)` gives, radians.
template <class Function>
double greatest_angle(const SurfaceMesh& mesh, const OrientationField& field, const Function& function) {
  double greatest = 0;
  for (std::int32_t t = 0; t < count_of(mesh); ++t) {
    const Vector normal = vector(mesh.triangle_normals()[t]);
    REQUIRE(field.has_direction(t));
    greatest = std::max(greatest, line_angle(vector(field.directions()[t]), function(centre(mesh, t), normal)));
  }
  return greatest;
}

std::int32_t half_turns_of(const SurfaceMesh& mesh, const OrientationField& field) {
  std::int32_t sum = 0;
  for (const auto& singularity : field_topology(mesh, field).singularities) sum += singularity.half_turns;
  return sum;
}

Soup demo(double edge_length = 3) {
  auto atrium = make_demo_atrium({.edge_length = edge_length});
  return {std::move(atrium.vertices), std::move(atrium.triangles)};
}

/// A frame that is the same everywhere on a flat surface.
ReferenceFrame constant_frame(const SurfaceMesh& mesh, const Vector& longitudinal) {
  ReferenceFrame frame;
  frame.longitudinal.assign(mesh.triangle_count(), detail::vec3(longitudinal.normalized()));
  return frame;
}

}  // namespace

TEST_CASE("one constraint makes a constant field on the plane and a helix on the cylinder") {
  const SurfaceMesh plane = jittered_grid(30, 20).mesh();
  const Vector direction(0.3, 0.8, 0);
  CHECK(greatest_angle(plane, interpolate(plane, Rows{held(plane, 77, direction)}).field,
                       [&](const Vector&, const Vector&) { return direction; }) <= 1e-12);

  const SurfaceMesh cylinder = test::cylinder(24, 15, 2, 9).mesh();
  for (const double pitch : {0.0, 0.4, 1.2}) {
    const auto helix = [&](const Vector&, const Vector& normal) {
      return Vector(std::cos(pitch) * Vector(normal.cross(Vector::UnitZ())) + std::sin(pitch) * Vector::UnitZ());
    };
    const Rows rows{held(cylinder, 40, helix({}, vector(cylinder.triangle_normals()[40])))};
    const auto result = interpolate(cylinder, rows);
    CHECK(greatest_angle(cylinder, result.field, helix) <= 1e-12);
    CHECK(std::ranges::all_of(result.confidence, [](double c) { return c > 1 - 1e-12 && c <= 1; }));
    CHECK(dirichlet_energy(cylinder, result.field) <= 1e-20);
  }
}

TEST_CASE("between rings of constant and of parallel fibres the phase is the harmonic one, to first order") {
  // phi = a (r^2 - r0^4 / r^2) exp(2 i alpha) + log(r / R) / log(r0 / R), 1 at r0 and exp(2 i (alpha + pi/2)) at R.
  const double inner = 1, outer = 3;
  const auto expected = [&](const Vector& c) {
    const double r = c.norm(), alpha = std::atan2(c.y(), c.x());
    const auto radial = [&](double x) { return x * x - std::pow(inner, 4) / (x * x); };
    return -radial(r) / radial(outer) * std::polar(1.0, 2 * alpha) + std::log(r / outer) / std::log(inner / outer);
  };
  std::vector<double> errors;
  for (const int n : {1, 2, 4}) {
    const SurfaceMesh mesh = annulus(40 * n, 12 * n, inner, outer).mesh();
    const Rows rows =
        at_border(mesh, [&](const Vector& c) { return c.norm() < 2 ? Vector(1, 0, 0) : Vector(-c.y(), c.x(), 0); });
    const auto result = interpolate(mesh, rows);
    double sum = 0, weight = 0;
    for (std::int32_t t = 0; t < count_of(mesh); ++t) {
      const Vector d = vector(result.field.directions()[t]);
      const auto phase = result.confidence[t] * std::pow(std::complex<double>(d.x(), d.y()), 2);
      sum += mesh.triangle_areas()[t] * std::norm(phase - expected(centre(mesh, t)));
      weight += mesh.triangle_areas()[t];
    }
    errors.push_back(std::sqrt(sum / weight));
  }
  CHECK(errors[0] < 0.08);
  // A constraint holds on whole triangles, not on the circle itself.
  for (int i = 0; i < 2; ++i) CHECK(errors[i] / errors[i + 1] > 1.8);
}

TEST_CASE("parallel conditions on both circles make a circular field, to first order") {
  const auto tangent = [](const Vector& c) { return Vector(-c.y(), c.x(), 0); };
  std::vector<double> errors;
  for (const int n : {1, 2, 4}) {
    const SurfaceMesh mesh = annulus(30 * n, 10 * n, 1, 3).mesh();
    const auto field = interpolate(mesh, at_border(mesh, tangent)).field;
    CHECK(field_topology(mesh, field).singularities.empty());
    errors.push_back(greatest_angle(mesh, field, [&](const Vector& c, const Vector&) { return tangent(c); }));
  }
  CHECK(errors[0] < 0.08);
  for (int i = 0; i < 2; ++i) CHECK(errors[i] / errors[i + 1] > 1.9);
}

TEST_CASE("hard constraints are met exactly, and weighted ones the closer the heavier") {
  const SurfaceMesh mesh = demo().mesh();
  Random random(5);
  for (const auto& rows : {random_rows(mesh, 40, random), random_rows(mesh, 400, random)}) {
    const auto result = interpolate(mesh, rows);
    for (const auto& [t, direction, weight, tract] : rows) {
      CHECK(line_angle(vector(result.field.directions()[t]), vector(direction)) <= 1e-15);
      CHECK(result.confidence[t] == 1);
    }
    CHECK(std::ranges::all_of(result.confidence, [](double c) { return c > 0 && c <= 1; }));
  }
  Rows rows{held(mesh, 100, {1, 0, 0}), held(mesh, 1000, {0, 1, 0}, 1)};
  double last = pi;
  for (const double weight : {1e-3, 1.0, 1e3, 1e9}) {
    rows[1].weight = weight;
    const auto field = interpolate(mesh, rows).field;
    const double angle = line_angle(vector(field.directions()[1000]), vector(rows[1].direction));
    CHECK(angle < last);
    last = angle;
  }
  CHECK(last < 1e-8);
}

TEST_CASE("with the least and the greatest weight the equations are still solved") {
  const auto uneven = [](const Vector& v) -> Vector {
    return {v.x() + 0.3 * std::sin(v.y() + 0.2 * v.x()), v.y() + 0.3 * std::sin(0.7 * v.x()), 0};
  };
  const SurfaceMesh mesh = mapped(grid(150, 100), uneven).mesh();
  const Vector slanted(1, 0.4, 0);
  for (const double weight : {least_weight, greatest_weight}) {
    // On a plane any weight, however small, makes a constant field of confidence 1.
    const auto result = interpolate(mesh, Rows{held(mesh, 0, slanted, weight)});
    CHECK(greatest_angle(mesh, result.field, [&](const Vector&, const Vector&) { return slanted; }) < 1e-4);
    CHECK(*std::ranges::min_element(result.confidence) > 1 - 1e-4);
    // Of two that weigh the same the field is halfway; where one weighs by far less it has no say.
    const Vector other(1, 0, 0), middle = slanted.normalized() + other;
    const auto last = count_of(mesh) - 1;
    const auto both = interpolate(mesh, Rows{held(mesh, 0, slanted, least_weight), held(mesh, last, other, weight)});
    const Vector expected = weight == least_weight ? middle : other;
    CHECK(greatest_angle(mesh, both.field, [&](const Vector&, const Vector&) { return expected; }) < 1e-4);
  }
}

TEST_CASE("on a curved surface weak weights leave little confidence, but a direction") {
  const SurfaceMesh mesh = sphere(3).mesh();
  const auto weak = interpolate(mesh, Rows{held(mesh, 0, {1, 1, 0}, 1e-3)});
  const auto weaker = interpolate(mesh, Rows{held(mesh, 0, {1, 1, 0}, 1e-5)});
  CHECK(*std::ranges::max_element(weak.confidence) < 0.01);
  CHECK(weaker.field.count(DirectionStatus::valid) == mesh.triangle_count());
  for (std::int32_t t = 0; t < count_of(mesh); ++t) {
    CHECK(weaker.confidence[t] < 0.011 * weak.confidence[t]);
    CHECK(line_angle(vector(weak.field.directions()[t]), vector(weaker.field.directions()[t])) < 1e-2);
  }
}

TEST_CASE("reversing a constraint changes nothing, and rotating the surface rotates the field") {
  const Soup soup = demo();
  const SurfaceMesh mesh = soup.mesh();
  Random random(6);
  const Rows rows = random_rows(mesh, 50, random);
  const auto expected = interpolate(mesh, rows).field.directions();
  Rows reversed = rows;
  for (auto& row : reversed) row.direction = detail::vec3(-vector(row.direction));
  CHECK(interpolate(mesh, reversed).field.directions() == expected);

  const Eigen::Matrix3d rotation = some_rotation();
  const SurfaceMesh turned = mapped(soup, [&](const Vector& v) { return Vector(7 * (rotation * v)); }).mesh();
  Rows turned_rows = rows;
  for (auto& row : turned_rows) row.direction = detail::vec3(rotation * vector(row.direction));
  const auto field = interpolate(turned, turned_rows);
  for (std::int32_t t = 0; t < count_of(mesh); ++t) {
    // Near singularities rounding turns directions more.
    const double tolerance = 1e-11 / field.confidence[t];
    CHECK(line_angle(vector(field.field.directions()[t]), rotation * vector(expected[t])) <= tolerance);
  }
}

TEST_CASE("edits give the bytes of a fresh interpolator") {
  const SurfaceMesh mesh = together(demo(), sphere(2, 40)).mesh();
  Random random(7);
  FieldInterpolator interpolator(mesh);
  Rows rows = random_rows(mesh, 60, random);
  for (int edit = 0; edit < 12; ++edit) {
    if (edit % 3 == 0) rows = random_rows(mesh, 20, random, edit % 2 == 0 ? hard : 2.5);
    if (edit % 3 == 1) rows.pop_back();
    if (edit % 3 == 2) rows.front().direction = held(mesh, rows.front().triangle, {0.2, 0.3, 0.9}).direction;
    const auto edited = interpolator.interpolate(rows), fresh = interpolate(mesh, rows);
    CHECK(edited.field.directions() == fresh.field.directions());
    CHECK(edited.confidence == fresh.confidence);
  }
  // Without any constraint, and back.
  CHECK(interpolator.interpolate({}).field.directions() == interpolate(mesh, Rows{}).field.directions());
  CHECK(interpolator.interpolate(rows).field.directions() == interpolate(mesh, rows).field.directions());
}

TEST_CASE("the indices of a closed surface add up to its Euler characteristic") {
  Random random(8);
  const SurfaceMesh ball = sphere(3).mesh(), ring = torus(30, 16).mesh();
  for (const std::uint64_t constraints : {0, 1, 30}) {
    CHECK(half_turns_of(ball, interpolate(ball, random_rows(ball, constraints, random)).field) == 4);
    CHECK(half_turns_of(ring, interpolate(ring, random_rows(ring, constraints, random)).field) == 0);
  }
}

TEST_CASE("parallel conditions on every loop leave singularities of the Euler characteristic") {
  const SurfaceMesh disk = grid(13, 11).mesh();
  const auto rows = at_border(disk, [](const Vector& c) {
    const double x = std::min(c.x(), 13 - c.x()), y = std::min(c.y(), 11 - c.y());
    return x < y ? Vector(0, 1, 0) : Vector(1, 0, 0);
  });
  const auto field = interpolate(disk, rows).field;
  const auto topology = field_topology(disk, field);
  CHECK(half_turns_of(disk, field) == 2 - topology.loop_half_turns.at(0).value());
}

TEST_CASE("fibres parallel to all borders leave exactly the Euler characteristic inside") {
  // Chi is -3: a sphere with five holes.
  for (const Soup& soup : {demo(), demo(2), cylinder(30, 12, 2, 6), annulus(30, 8, 1, 3)}) {
    const SurfaceMesh mesh = soup.mesh();
    std::vector<BoundaryCondition> conditions;
    for (std::size_t loop = 0; loop < mesh.boundary_loops().size(); ++loop) {
      conditions.push_back({static_cast<std::int32_t>(loop), BoundaryRule::parallel});
    }
    const auto field = interpolate(mesh, make_constraints(mesh, {}, conditions).triangles).field;
    const auto topology = field_topology(mesh, field);
    for (const auto& turns : topology.loop_half_turns) CHECK(turns == 0);
    CHECK(half_turns_of(mesh, field) == 2 * mesh.components()[0].euler_characteristic);
  }
}

TEST_CASE("without constraints the field is the smoothest one") {
  const SurfaceMesh plane = jittered_grid(12, 12).mesh();
  CHECK(dirichlet_energy(plane, interpolate(plane, Rows{}).field) <= 1e-12);
  const SurfaceMesh strip = moebius_strip(60, 6).mesh();
  const auto result = interpolate(strip, Rows{});
  CHECK(*std::ranges::max_element(result.confidence) == doctest::Approx(1).epsilon(1e-12));
  Random random(9);
  for (int i = 0; i < 5; ++i) {
    const auto other = interpolate(strip, random_rows(strip, 3, random));
    CHECK(dirichlet_energy(strip, result.field) < dirichlet_energy(strip, other.field));
  }
  // Its magnitude is scaled to a greatest of 1, not cut off there.
  const auto confidence = interpolate(sphere(3).mesh(), Rows{}).confidence;
  CHECK(std::ranges::count_if(confidence, [](double c) { return c > 0.99999; }) < 100);
  CHECK(*std::ranges::max_element(confidence) == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("on a surface without sides the field does not depend on where the seam runs") {
  const Soup strip = moebius_strip(40, 5), bottle = klein_bottle(24, 14);
  for (const Soup& soup : {strip, bottle}) {
    const SurfaceMesh mesh = soup.mesh();
    Random random(11);
    const Rows rows = random_rows(mesh, 4, random);
    const auto expected = interpolate(mesh, rows);
    Soup wound = soup;
    for (auto& [a, b, c] : wound.triangles) {
      if (random.below(2) == 0) std::swap(a, b);
    }
    const SurfaceMesh other = wound.mesh();
    const auto result = interpolate(other, rows);
    for (std::int32_t t = 0; t < count_of(mesh); ++t) {
      CHECK(line_angle(vector(result.field.directions()[t]), vector(expected.field.directions()[t])) <=
            1e-11 / expected.confidence[t]);
    }
  }
}

TEST_CASE("in a constant frame of the plane the paper's way and the connection are one") {
  const SurfaceMesh plane = jittered_grid(25, 25).mesh();
  Random random(10);
  const Rows rows = random_rows(plane, 40, random);
  const auto one = interpolate(plane, rows), other = interpolate(plane, constant_frame(plane, {0.6, 1, 0}), rows);
  for (std::int32_t t = 0; t < count_of(plane); ++t) {
    CHECK(other.confidence[t] == doctest::Approx(one.confidence[t]).epsilon(1e-11));
    CHECK(line_angle(vector(one.field.directions()[t]), vector(other.field.directions()[t])) <=
          1e-12 / one.confidence[t]);
  }
}

TEST_CASE("constraints that make no sense are refused") {
  const SurfaceMesh mesh = grid(3, 3).mesh();
  const auto refused = [&](Rows rows, const char* message) {
    CHECK_THROWS_WITH_AS(interpolate(mesh, rows), doctest::Contains(message), InvalidField);
  };
  const TriangleConstraint good{4, {1, 0, 0}, hard, 0};
  refused({{-1, {1, 0, 0}, hard, 0}}, "triangle -1 is for a mesh of 18");
  refused({{18, {1, 0, 0}, hard, 0}}, "triangle 18");
  refused({good, good}, "given twice");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double weight : {0.0, -1.0, nan, -hard, 0.999 * least_weight, 1.001 * greatest_weight}) {
    refused({{4, {1, 0, 0}, weight, 0}}, "triangle 4 has the weight ");
  }
  for (const double x : {0.0, hard, std::numeric_limits<double>::quiet_NaN()}) {
    refused({{4, {x, 0, 0}, hard, 0}}, "zero, not finite or normal");
  }
  refused({{4, {0, 0, 1}, hard, 0}}, "zero, not finite or normal");
  CHECK_THROWS_AS(FieldInterpolator(mesh, constant_frame(one_triangle().mesh(), {1, 0, 0})), InvalidField);
  FieldInterpolator interpolator(mesh);
  CHECK_THROWS_AS(interpolator.interpolate(Rows{good, good}), InvalidField);
  CHECK(interpolator.interpolate(Rows{good}).confidence[4] == 1);
}

TEST_CASE("lone triangles and components without constraints get a direction") {
  const SurfaceMesh mesh = together(one_triangle(), moved(grid(4, 4), {5, 0, 0})).mesh();
  for (const Rows& rows : {Rows{}, Rows{held(mesh, 0, {1, 1, 0})}, Rows{held(mesh, 7, {1, 1, 0}, 0.5)}}) {
    const auto result = interpolate(mesh, rows);
    CHECK(result.field.count(DirectionStatus::valid) == mesh.triangle_count());
    CHECK(std::ranges::all_of(result.confidence, [](double c) { return c > 0 && c <= 1; }));
  }
}

TEST_CASE("interpolated directions are unit, in their planes and signed as those of any field") {
  const auto mesh = torus(24, 12).mesh();
  Random random(5);
  auto rows = random_rows(mesh, 12, random);
  for (auto& row : rows) row.direction = detail::vec3(-3 * vector(row.direction));
  const auto field = interpolate(mesh, rows).field;
  const auto again = OrientationField::from_triangle_vectors(mesh, field.directions());
  for (std::int32_t t = 0; t < count_of(mesh); ++t) {
    CHECK((vector(field.directions()[t]) - vector(again.directions()[t])).norm() <= 1e-15);
    CHECK(field.out_of_plane_angles()[t] == 0);
  }
}

}  // namespace pectinate::test
