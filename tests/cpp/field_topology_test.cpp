// SPDX-License-Identifier: MIT
#include "pectinate/field_topology.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "fields.hpp"
#include "pectinate/demo_atrium.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;
using detail::vector;

std::int32_t all_half_turns(const FieldTopology& topology) {
  std::int32_t sum = 0;
  for (const auto& singularity : topology.singularities) sum += singularity.half_turns;
  for (const auto& turns : topology.loop_half_turns) sum += turns.value();
  return sum;
}

std::int32_t euler_characteristic(const SurfaceMesh& mesh) {
  std::int32_t sum = 0;
  for (const auto& component : mesh.components()) sum += component.euler_characteristic;
  return sum;
}

Soup demo() {
  auto atrium = make_demo_atrium({.edge_length = 3});
  return {std::move(atrium.vertices), std::move(atrium.triangles)};
}

/// (x + i y) ^ power, as a line of half that angle.
OrientationField power_field(const SurfaceMesh& mesh, double power) {
  return field_of(mesh, [&](const Vector& c, const Vector&) {
    const double angle = power * std::atan2(c.y(), c.x());
    return Vector(std::cos(angle), std::sin(angle), 0);
  });
}

}  // namespace

TEST_CASE("the half turns of any field add up to twice the Euler characteristic") {
  for (const Soup& soup :
       {tetrahedron(), sphere(2), torus(14, 9), grid(5, 4), cylinder(9, 3, 1, 2), annulus(12, 3, 1, 2),
        moebius_strip(16, 3), klein_bottle(17, 11), demo(), together(torus(9, 7), grid(3, 3))}) {
    const SurfaceMesh mesh = soup.mesh();
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      CHECK(all_half_turns(field_topology(mesh, random_field(mesh, seed))) == 2 * euler_characteristic(mesh));
    }
    CHECK(all_half_turns(field_topology(mesh, smooth_field(mesh))) == 2 * euler_characteristic(mesh));
  }
}

TEST_CASE("right angles between neighbours, which could turn either way, turn one way seen from both") {
  const SurfaceMesh mesh = grid(12, 9).mesh();
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Random random(seed);
    const auto field = field_of(mesh, [&](const Vector&, const Vector&) -> Vector {
      return random.below(2) == 0 ? Vector::UnitX() : Vector::UnitY();
    });
    CHECK(all_half_turns(field_topology(mesh, field)) == 2);
  }
}

TEST_CASE("a singularity of index k/2 is found where it is, with k half turns") {
  const SurfaceMesh mesh = jittered_grid(20, 20).mesh();
  const SurfaceMesh centred = moved(jittered_grid(20, 20), {-10, -10, 0}).mesh();
  CHECK(field_topology(mesh, constant_field(mesh, Vector(1, 2, 0))).singularities.empty());
  for (const int k : {-3, -2, -1, 1, 2, 3}) {
    const auto topology = field_topology(centred, power_field(centred, k / 2.0));
    REQUIRE(topology.singularities.size() >= 1);
    std::int32_t sum = 0;
    for (const auto& singularity : topology.singularities) {
      CHECK(vector(singularity.position).norm() < 1.5);
      CHECK(singularity.position == centred.vertices()[singularity.vertex]);
      sum += singularity.half_turns;
    }
    CHECK(sum == k);
    CHECK(topology.loop_half_turns.at(0) == 2 - k);
  }
}

TEST_CASE("fibres along or across a loop make no turn against it") {
  for (const bool along : {true, false}) {
    const SurfaceMesh mesh = annulus(30, 4, 1, 2).mesh();
    const auto field =
        field_of(mesh, [&](const Vector& c, const Vector& n) -> Vector { return along ? n.cross(c) : c; });
    const auto topology = field_topology(mesh, field);
    CHECK(topology.singularities.empty());
    CHECK(topology.loop_half_turns == std::vector<std::optional<std::int32_t>>{0, 0});
  }
}

TEST_CASE("signs, rotation and winding change no topology") {
  const Soup soup = demo();
  const SurfaceMesh mesh = soup.mesh();
  const auto count = [](const FieldTopology& topology) {
    std::vector<std::pair<std::int32_t, std::int32_t>> all;
    for (const auto& s : topology.singularities) all.emplace_back(s.vertex, s.half_turns);
    return all;
  };
  const auto field = smooth_field(mesh);
  const auto expected = count(field_topology(mesh, field));
  auto vectors = triangle_vectors(mesh, [](const Vector& c, const Vector&) { return Vector(-c.y(), c.x(), 1); });
  const auto one = count(field_topology(mesh, OrientationField::from_triangle_vectors(mesh, vectors)));
  for (auto& v : vectors) v = {-v[0], -v[1], -v[2]};
  CHECK(count(field_topology(mesh, OrientationField::from_triangle_vectors(mesh, vectors))) == one);
  const Eigen::Matrix3d rotation = some_rotation();
  const SurfaceMesh turned = mapped(soup, [&](const Vector& v) { return Vector(rotation * v); }).mesh();
  std::vector<Vec3> turned_vectors;
  for (const auto& d : field.directions()) turned_vectors.push_back(detail::vec3(rotation * vector(d)));
  CHECK(count(field_topology(turned, OrientationField::from_triangle_vectors(turned, turned_vectors))) == expected);
}

TEST_CASE("where directions are missing nothing is claimed") {
  const SurfaceMesh mesh = grid(6, 6).mesh();
  auto vectors = triangle_vectors(mesh, [](const Vector& c, const Vector&) { return Vector(c.x() - 3, c.y() - 3, 0); });
  CHECK_FALSE(field_topology(mesh, OrientationField::from_triangle_vectors(mesh, vectors)).singularities.empty());
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    const Vector c = centre(mesh, t);
    if (std::max(std::abs(c.x() - 3), std::abs(c.y() - 3)) < 1.5) vectors[t] = {0, 0, 0};
  }
  vectors[0] = {0, 0, 0};
  const auto topology = field_topology(mesh, OrientationField::from_triangle_vectors(mesh, vectors));
  CHECK(topology.singularities.empty());
  CHECK_FALSE(topology.loop_half_turns.at(0).has_value());
}

TEST_CASE("a vortex around which one direction is missing is not claimed") {
  const SurfaceMesh mesh = grid(6, 6).mesh();
  const auto all =
      triangle_vectors(mesh, [](const Vector& c, const Vector&) { return Vector(c.x() - 3, c.y() - 3, 0); });
  int around = 0;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    const auto& corners = mesh.triangles()[t];
    if (std::ranges::find(corners, 24) == corners.end()) continue;  // the vertex (3, 3)
    ++around;
    auto vectors = all;
    vectors[t] = {0, 0, 0};
    CHECK(field_topology(mesh, OrientationField::from_triangle_vectors(mesh, vectors)).singularities.empty());
  }
  CHECK(around == 6);
}

TEST_CASE("the Dirichlet energy is that of the formula, whatever the scale") {
  // Two equilateral triangles: the circumcentres are 1 / sqrt(3) apart, so the weight of their edge is sqrt(3).
  const double height = std::sqrt(0.75);
  const Soup rhombus{{{0, 0, 0}, {1, 0, 0}, {0.5, height, 0}, {1.5, height, 0}}, {{0, 1, 2}, {1, 3, 2}}};
  for (const double scale : {1.0, 1000.0}) {
    const SurfaceMesh mesh = mapped(rhombus, [&](const Vector& v) { return Vector(scale * v); }).mesh();
    for (const double angle : {0.0, 0.3, 1.5}) {
      const std::vector<Vec3> vectors{{1, 0, 0}, {std::cos(angle), std::sin(angle), 0}};
      const double jump = 2 * std::sin(angle);
      CHECK(dirichlet_energy(mesh, OrientationField::from_triangle_vectors(mesh, vectors)) ==
            doctest::Approx(std::sqrt(3.0) * jump * jump / 2).epsilon(1e-12));
    }
  }
  const SurfaceMesh strip = moebius_strip(24, 2).mesh();
  const auto field = random_field(strip, 4);
  std::vector<Vec3> reversed;
  for (const auto& d : field.directions()) reversed.push_back({-d[0], -d[1], -d[2]});
  CHECK(dirichlet_energy(strip, OrientationField::from_triangle_vectors(strip, reversed)) ==
        dirichlet_energy(strip, field));
}

TEST_CASE("triangles without a direction have no energy: without them a strip with a seam and one cut open agree") {
  Soup soup = moebius_strip(24, 2);
  const SurfaceMesh strip = soup.mesh();
  auto vectors = random_field(strip, 4).directions();
  const auto whole = dirichlet_energy(strip, OrientationField::from_triangle_vectors(strip, vectors));
  std::size_t between = 0;  // the first two lines across
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const auto& [a, b, c] = soup.triangles[t];
    if (std::max({a, b, c}) >= 2 * 3 || std::min({a, b, c}) >= 3) continue;
    vectors[t] = {0, 0, 0};
    ++between;
  }
  REQUIRE(between == 4);
  const auto seamed = dirichlet_energy(strip, OrientationField::from_triangle_vectors(strip, vectors));
  Soup cut{soup.vertices, {}};
  std::vector<Vec3> kept;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    if (vectors[t] == Vec3{0, 0, 0}) continue;
    cut.triangles.push_back(soup.triangles[t]);
    kept.push_back(vectors[t]);
  }
  const SurfaceMesh open = cut.mesh();
  REQUIRE(strip.components()[0].orientable == false);
  REQUIRE(open.components()[0].orientable);
  CHECK(dirichlet_energy(open, OrientationField::from_triangle_vectors(open, kept)) ==
        doctest::Approx(seamed).epsilon(1e-12));
  CHECK(seamed < whole);
}

}  // namespace pectinate::test
