// SPDX-License-Identifier: MIT
#include "pectinate/orientation_field.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "fields.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;
using detail::vector;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<Vec3> random_vectors(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> vectors(count);
  for (auto& v : vectors) {
    const double scale = std::pow(10, 40 * random.unit() - 20);
    for (auto& x : v) x = scale * (2 * random.unit() - 1);
  }
  return vectors;
}

template <class Row>
std::vector<Row> some_reversed(std::vector<Row> rows, std::uint64_t seed) {
  Random random(seed);
  for (auto& row : rows) {
    if (random.below(2) == 0) continue;
    for (auto& x : row) x = -x;
  }
  return rows;
}

SymmetricTensor outer_product(const Vec3& v) {
  return {v[0] * v[0], v[1] * v[1], v[2] * v[2], v[0] * v[1], v[1] * v[2], v[0] * v[2]};
}

void check_unit_and_tangent(const SurfaceMesh& mesh, const OrientationField& field) {
  REQUIRE(field.directions().size() == mesh.triangle_count());
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    const Vector direction = vector(field.directions()[t]);
    if (field.has_direction(t)) {
      CHECK(std::abs(direction.norm() - 1) < 1e-14);
      CHECK(std::abs(direction.dot(vector(mesh.triangle_normals()[t]))) < 1e-12);
    } else {
      CHECK(direction.norm() == 0);
      CHECK(field.out_of_plane_angles()[t] == 0);
    }
  }
}

bool same_bytes(const OrientationField& a, const OrientationField& b) {
  return a.directions() == b.directions() && a.status() == b.status() &&
         a.out_of_plane_angles() == b.out_of_plane_angles();
}

/// The line in the plane z = 0 at an angle from the x axis.
Vec3 flat(double angle, double length = 1) {
  return {length * std::cos(angle), length * std::sin(angle), 0};
}

/// The direction that one triangle in the plane z = 0 gets from the vectors at its corners.
Vector average_of(const std::vector<Vec3>& corners) {
  return vector(OrientationField::from_vertex_vectors(one_triangle().mesh(), corners).directions()[0]);
}

}  // namespace

TEST_CASE("field: directions are unit vectors in the planes of their triangles") {
  for (const auto& soup : {jittered_grid(6, 5), sphere(3), moebius_strip(20, 3), three_on_an_edge()}) {
    const auto mesh = soup.mesh();
    check_unit_and_tangent(mesh, random_field(mesh, 5));
    const auto vectors = random_vectors(mesh.input_vertex_count(), 6);
    check_unit_and_tangent(mesh, OrientationField::from_vertex_vectors(mesh, vectors));
  }
}

TEST_CASE("field: the direction is the projection of the input, which is tilted by the out-of-plane angle") {
  const auto mesh = sphere(2).mesh();
  const auto vectors = random_vectors(mesh.triangle_count(), 8);
  const auto field = OrientationField::from_triangle_vectors(mesh, vectors);
  for (std::size_t t = 0; t < vectors.size(); ++t) {
    const Vector unit = vector(vectors[t]).normalized(), normal = vector(mesh.triangle_normals()[t]);
    const Vector expected = (unit - unit.dot(normal) * normal).normalized();
    CHECK(line_angle(vector(field.directions()[t]), expected) < 1e-12);
    CHECK(field.out_of_plane_angles()[t] == doctest::Approx(std::asin(std::abs(unit.dot(normal)))).epsilon(1e-9));
  }
}

TEST_CASE("field: small out-of-plane angles are right to the last bits") {
  const auto mesh = jittered_grid(20, 20).mesh();
  Random random(9);
  for (int round = 0; round < 20; ++round) {
    std::vector<Vec3> vectors(mesh.input_triangle_count());
    // In some rounds all are so small that they are computed in another way, in others some.
    for (auto& vector : vectors) vector = {1, 0, std::pow(10, -3 - 9 * random.unit() - (round % 2 == 0 ? 3 : 0))};
    const auto field = OrientationField::from_triangle_vectors(mesh, vectors);
    for (std::size_t t = 0; t < vectors.size(); ++t) {
      const double expected = std::atan(vectors[t][2]);
      CHECK(std::abs(field.out_of_plane_angles()[t] - expected) <=
            4 * std::numeric_limits<double>::epsilon() * expected);
    }
  }
}

TEST_CASE("field: reversing inputs changes no byte") {
  const auto mesh = sphere(2).mesh();
  const auto triangle_vectors = random_vectors(mesh.input_triangle_count(), 1);
  const auto vertex_vectors = random_vectors(mesh.input_vertex_count(), 2);
  const auto by_triangle = OrientationField::from_triangle_vectors(mesh, triangle_vectors);
  const auto by_vertex = OrientationField::from_vertex_vectors(mesh, vertex_vectors);
  for (const std::uint64_t seed : {3, 4, 5}) {
    CHECK(
        same_bytes(by_triangle, OrientationField::from_triangle_vectors(mesh, some_reversed(triangle_vectors, seed))));
    CHECK(same_bytes(by_vertex, OrientationField::from_vertex_vectors(mesh, some_reversed(vertex_vectors, seed))));
  }
}

TEST_CASE("field: lengths do not matter, however great or small") {
  const auto mesh = sphere(2).mesh();
  const auto vectors = random_vectors(mesh.input_triangle_count(), 1);
  const auto expected = OrientationField::from_triangle_vectors(mesh, vectors);
  for (const double factor : {0x1p-900, 0x1p900}) {
    auto scaled = vectors;
    for (auto& v : scaled) v = {v[0] * factor, v[1] * factor, v[2] * factor};
    CHECK(same_bytes(expected, OrientationField::from_triangle_vectors(mesh, scaled)));
  }
}

TEST_CASE("field: each status, counted") {
  const auto mesh = jittered_grid(2, 2).mesh();  // 8 triangles
  const std::vector<Vec3> vectors{{1, 2, 0}, {0, 0, 0},       {nan, 0, 0},  {0, infinity, 0},
                                  {0, 0, 3}, {0, 0, -1e-200}, {-0.0, 0, 0}, {1e-6, 0, 1}};
  const auto field = OrientationField::from_triangle_vectors(mesh, vectors);
  using enum DirectionStatus;
  CHECK(field.status() == std::vector{valid, zero, non_finite, non_finite, normal, normal, zero, valid});
  CHECK(field.count(valid) == 2);
  CHECK(field.count(zero) == 2);
  CHECK(field.count(non_finite) == 2);
  CHECK(field.count(normal) == 2);
  CHECK(field.count(isotropic) == 0);
  check_unit_and_tangent(mesh, field);
}

TEST_CASE("field: each status of tensors") {
  const auto mesh = jittered_grid(2, 2).mesh();
  const std::vector<SymmetricTensor> tensors{{1, 2, 3, 0, 0, 0},   {0, 0, 0, 0, 0, 0}, {1, 1, nan, 0, 0, 0},
                                             {1, 1, 1, 0, 0, 0},   {0, 0, 1, 0, 0, 0}, {2, 2, 7, 0, 0, 0},
                                             {-1, -2, 0, 0, 0, 0}, {0, 0, 0, 1, 0, 0}};
  const auto field = OrientationField::from_triangle_tensors(mesh, tensors);
  using enum DirectionStatus;
  CHECK(field.status() == std::vector{valid, zero, non_finite, isotropic, normal, isotropic, valid, valid});
  CHECK(std::abs(field.directions()[0][1]) == doctest::Approx(1).epsilon(1e-15));  // the greatest in the plane: y
  CHECK(std::abs(field.directions()[6][0]) == doctest::Approx(1).epsilon(1e-15));  // the greatest, not the strongest
  CHECK(line_angle(vector(field.directions()[7]), Vector(1, 1, 0)) < 1e-15);
}

TEST_CASE("field: a tensor v v^T says what v says") {
  const auto mesh = sphere(2).mesh();
  const auto vectors = random_vectors(mesh.input_triangle_count(), 9);
  std::vector<SymmetricTensor> tensors;
  for (const auto& v : vectors) tensors.push_back(outer_product(v));
  const auto by_vector = OrientationField::from_triangle_vectors(mesh, vectors);
  const auto by_tensor = OrientationField::from_triangle_tensors(mesh, tensors);
  CHECK(by_vector.status() == by_tensor.status());
  for (std::size_t t = 0; t < vectors.size(); ++t) {
    const double tilt = std::cos(by_vector.out_of_plane_angles()[t]);  // what is left in the plane
    CHECK(line_angle(vector(by_vector.directions()[t]), vector(by_tensor.directions()[t])) < 1e-14 / (tilt * tilt));
  }
}

TEST_CASE("field: corners are averaged as lines, not as vectors") {
  CHECK(line_angle(average_of({flat(0.4), flat(0.4, -1), flat(0.4, 5)}), vector(flat(0.4))) < 1e-15);
  CHECK(line_angle(average_of({flat(0.4), flat(0.4, -1), flat(0.4, -1)}), vector(flat(0.4))) < 1e-15);
  // Lengths do not weigh: the average of two lines halves the angle between them.
  CHECK(line_angle(average_of({flat(0.2), flat(0.8, -100), {0, 0, 0}}), vector(flat(0.5))) < 1e-15);
  // The line angle of 0.1 and pi - 0.1 is 0.2: the average is the x axis, not the y axis.
  CHECK(line_angle(average_of({flat(0.1), flat(std::numbers::pi - 0.1), {nan, 0, 0}}), Vector(1, 0, 0)) < 1e-15);
}

TEST_CASE("field: three corners at 60 degrees prefer no direction") {
  const auto mesh = one_triangle().mesh();
  const double third = std::numbers::pi / 3;
  const auto make = [&](const std::vector<Vec3>& corners) { OrientationField::from_vertex_vectors(mesh, corners); };
  CHECK_THROWS_AS(make({flat(0), flat(third), flat(2 * third)}), InvalidField);
  const auto two = together(one_triangle(), moved(one_triangle(), {5, 0, 0})).mesh();
  const auto field = OrientationField::from_vertex_vectors(
      two, std::vector<Vec3>{flat(0), flat(third), flat(2 * third), flat(0), flat(0), flat(0)});
  CHECK(field.status() == std::vector{DirectionStatus::isotropic, DirectionStatus::valid});
}

TEST_CASE("field: it turns with the surface") {
  const Eigen::Matrix3d rotation = some_rotation();
  const auto soup = sphere(2);
  const auto mesh = soup.mesh(), turned = mapped(soup, [&](const Vector& v) { return rotation * v; }).mesh();
  const auto vectors = random_vectors(mesh.input_triangle_count(), 4);
  const auto corner_vectors = random_vectors(mesh.input_vertex_count(), 5);
  const auto rotated = [&](std::vector<Vec3> all) {
    for (auto& v : all) v = detail::vec3(rotation * vector(v));
    return all;
  };
  const auto check = [&](const OrientationField& field, const OrientationField& other) {
    CHECK(field.status() == other.status());
    for (std::size_t t = 0; t < field.directions().size(); ++t) {
      CHECK((rotation * vector(field.directions()[t]) - vector(other.directions()[t])).norm() < 1e-11);
    }
  };
  check(OrientationField::from_triangle_vectors(mesh, vectors),
        OrientationField::from_triangle_vectors(turned, rotated(vectors)));
  check(OrientationField::from_vertex_vectors(mesh, corner_vectors),
        OrientationField::from_vertex_vectors(turned, rotated(corner_vectors)));
}

TEST_CASE("field: a triangle's direction does not depend on how many there are") {
  const auto all = jittered_grid(3, 2);
  const auto vectors = random_vectors(all.triangles.size(), 3);
  const auto expected = OrientationField::from_triangle_vectors(all.mesh(), vectors);
  for (std::size_t count = 1; count < vectors.size(); ++count) {
    auto soup = all;
    soup.triangles.resize(count);
    const auto field = OrientationField::from_triangle_vectors(soup.mesh(), std::span(vectors).first(count));
    for (std::size_t t = 0; t < count; ++t) {
      CHECK(field.directions()[t] == expected.directions()[t]);
      CHECK(field.out_of_plane_angles()[t] == expected.out_of_plane_angles()[t]);
    }
  }
}

TEST_CASE("field: rows follow the input, dropped triangles included") {
  Soup soup = jittered_grid(2, 1);
  soup.triangles.insert(soup.triangles.begin() + 1, {0, 0, 1});
  const auto mesh = soup.mesh();
  const std::vector<Vec3> vectors{flat(0.1), {nan, nan, nan}, flat(0.2), flat(0.3), flat(0.4)};
  const auto field = OrientationField::from_triangle_vectors(mesh, vectors);
  CHECK(field.count(DirectionStatus::valid) == 4);
  for (std::size_t t = 0; t < 4; ++t) {
    CHECK(line_angle(vector(field.directions()[t]), vector(vectors[mesh.input_triangle()[t]])) < 1e-15);
  }
}

TEST_CASE("field: copies of a split vertex share the input's vector") {
  const auto mesh = three_on_an_edge().mesh();
  std::vector<Vec3> vectors(mesh.input_vertex_count(), Vec3{0, 0, 0});
  vectors[0] = {0, 0, 2};
  const auto field = OrientationField::from_vertex_vectors(mesh, vectors);
  for (const auto& direction : field.directions()) CHECK(std::abs(direction[2]) == doctest::Approx(1).epsilon(1e-15));
}

TEST_CASE("field: a wrong count and a field of nothing are refused") {
  const auto mesh = jittered_grid(2, 1).mesh();  // 4 triangles, 6 vertices
  using Vectors = std::vector<Vec3>;
  using Tensors = std::vector<SymmetricTensor>;
  CHECK_THROWS_AS(OrientationField::from_triangle_vectors(mesh, Vectors(6, Vec3{1, 0, 0})), InvalidField);
  CHECK_THROWS_AS(OrientationField::from_triangle_vectors(mesh, Vectors{}), InvalidField);
  CHECK_THROWS_AS(OrientationField::from_vertex_vectors(mesh, Vectors(4, Vec3{1, 0, 0})), InvalidField);
  CHECK_THROWS_AS(OrientationField::from_triangle_tensors(mesh, Tensors(5)), InvalidField);
  CHECK_THROWS_AS(OrientationField::from_vertex_tensors(mesh, Tensors(7)), InvalidField);
  CHECK_THROWS_AS(OrientationField::from_triangle_vectors(mesh, Vectors(4, Vec3{0, 0, 0})), InvalidField);
  CHECK_THROWS_AS(OrientationField::from_triangle_vectors(mesh, Vectors(4, Vec3{0, 0, 1})), InvalidField);
  CHECK_THROWS_AS(OrientationField::from_vertex_vectors(mesh, Vectors(6, Vec3{nan, 0, 0})), InvalidField);
  CHECK_THROWS_AS(OrientationField::from_triangle_tensors(mesh, Tensors(4, SymmetricTensor{1, 1, 1, 0, 0, 0})),
                  InvalidField);
}

}  // namespace pectinate::test
