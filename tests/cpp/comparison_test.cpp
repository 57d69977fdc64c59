// SPDX-License-Identifier: MIT
#include "pectinate/comparison.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

#include "fields.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;
using detail::vector;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double degree = std::numbers::pi / 180;

OrientationField flat_field(const SurfaceMesh& mesh, double angle) {
  return constant_field(mesh, {std::cos(angle), std::sin(angle), 0});
}

std::vector<Vec3> negated(std::vector<Vec3> vectors, std::uint64_t seed) {
  Random random(seed);
  for (auto& v : vectors) {
    if (random.below(2) == 1) v = {-v[0], -v[1], -v[2]};
  }
  return vectors;
}

/// From `before` to `after`, to the left, radians in (-pi/2, pi/2].
double turned_by(const SurfaceMesh& mesh, std::size_t t, const OrientationField& before,
                 const OrientationField& after) {
  const auto from = vector(before.directions()[t]), to = vector(after.directions()[t]);
  const double left = vector(mesh.triangle_normals()[t]).dot(from.cross(to)), ahead = from.dot(to);
  return ahead < 0 ? std::atan2(-left, -ahead) : std::atan2(left, ahead);
}

/// Along the circles of latitude: smooth but at the poles.
Vector eastwards(const Vector& place) {
  return Vector::UnitZ().cross(place);
}

}  // namespace

TEST_CASE("comparison: the angle between constant fields is that of their lines") {
  const auto mesh = jittered_grid(4, 3).mesh();
  for (const double a : {0.0, 0.3, 1.5, 2.9}) {
    for (const double b : {0.0, 1e-9, 0.4, 1.5, 3.1}) {
      const auto first = flat_field(mesh, a), second = flat_field(mesh, b);
      const double expected = std::abs(std::remainder(a - b, std::numbers::pi));
      for (const double angle : angles_between(first, second)) CHECK(std::abs(angle - expected) < 1e-15);
      CHECK(angles_between(first, second) == angles_between(second, first));
    }
  }
}

TEST_CASE("comparison: there is no angle where a field has no direction") {
  const auto mesh = grid(2, 1).mesh();
  const std::vector<Vec3> x(4, Vec3{1, 0, 0});
  auto sparse = x, normal = x;
  sparse[1] = {0, 0, 0};
  normal[2] = {0, 0, 1};
  const auto angles = angles_between(OrientationField::from_triangle_vectors(mesh, sparse),
                                     OrientationField::from_triangle_vectors(mesh, normal));
  for (std::size_t t = 0; t < 4; ++t) CHECK(std::isnan(angles[t]) == (t == 1 || t == 2));
  CHECK(angles[0] == 0);
  CHECK(angles[3] == 0);
}

TEST_CASE("comparison: angular noise has the statistics of the normal distribution") {
  const auto mesh = grid(250, 200).mesh();
  const auto field = flat_field(mesh, 0.4);
  const double count = 100000;
  REQUIRE(static_cast<double>(mesh.triangle_count()) == count);
  for (const double sigma : {5 * degree, 10 * degree}) {
    const auto noisy = add_angular_noise(mesh, field, sigma, 3);
    double mean = 0, square = 0, fourth = 0, lagged = 0, previous = 0;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const double angle = turned_by(mesh, t, field, noisy) / sigma;
      mean += angle / count;
      square += angle * angle / count;
      fourth += std::pow(angle, 4) / count;
      lagged += angle * previous / count;
      previous = angle;
      CHECK(std::abs(noisy.directions()[t][2]) < 1e-15);
    }
    CHECK(std::abs(mean) < 4 / std::sqrt(count));
    CHECK(std::abs(std::sqrt(square) - 1) < 4 / std::sqrt(2 * count));
    CHECK(std::abs(fourth - 3) < 4 * std::sqrt(96 / count));
    CHECK(std::abs(lagged) < 4 / std::sqrt(count));
  }
}

TEST_CASE("comparison: noise depends on the seed and the triangle, not on the field") {
  const auto mesh = sphere(3).mesh();
  const auto vectors = triangle_vectors(mesh, [](const Vector& c, const Vector&) { return eastwards(c); });
  const auto field = OrientationField::from_triangle_vectors(mesh, vectors);
  const auto noisy = add_angular_noise(mesh, field, 0.2, 7);
  CHECK(add_angular_noise(mesh, field, 0.2, 7).directions() == noisy.directions());
  CHECK(add_angular_noise(mesh, field, 0.2, 8).directions() != noisy.directions());
  CHECK(add_angular_noise(mesh, field, 0.2).directions() == add_angular_noise(mesh, field, 0.2, 1).directions());

  auto sparse = negated(vectors, 5);
  for (std::size_t t = 0; t < sparse.size(); t += 3) sparse[t] = {0, 0, 0};
  const auto partly = add_angular_noise(mesh, OrientationField::from_triangle_vectors(mesh, sparse), 0.2, 7);
  for (std::size_t t = 0; t < sparse.size(); ++t) {
    CHECK(partly.directions()[t] == (t % 3 == 0 ? Vec3{0, 0, 0} : noisy.directions()[t]));
  }
  const auto other = random_field(mesh, 4);
  const auto other_noisy = add_angular_noise(mesh, other, 0.2, 7);
  for (std::size_t t = 0; t < sparse.size(); ++t) {
    const double expected = turned_by(mesh, t, field, noisy);
    CHECK(turned_by(mesh, t, other, other_noisy) == doctest::Approx(expected).epsilon(1e-12));
    CHECK(std::abs(vector(noisy.directions()[t]).dot(vector(mesh.triangle_normals()[t]))) < 1e-15);
  }
}

TEST_CASE("comparison: no noise leaves the field") {
  const auto mesh = sphere(3).mesh();
  const auto field = random_field(mesh, 2);
  CHECK(add_angular_noise(mesh, field, 0).directions() == field.directions());
  for (const double angle : angles_between(field, add_angular_noise(mesh, field, 1e-16))) CHECK(angle < 1e-14);
}

TEST_CASE("comparison: a standard deviation that is none, and fields of other meshes, are refused") {
  const auto mesh = grid(2, 2).mesh(), other = grid(3, 2).mesh();
  const auto field = flat_field(mesh, 0), foreign = flat_field(other, 0);
  for (const double bad : {nan, -1e-9, infinity, -infinity, 3.1416}) {
    CHECK_THROWS_AS(add_angular_noise(mesh, field, bad), InvalidOption);
  }
  CHECK(add_angular_noise(mesh, field, std::numbers::pi).count(DirectionStatus::valid) == mesh.triangle_count());
  CHECK_THROWS_AS(add_angular_noise(mesh, foreign, 0.1), InvalidField);
  CHECK_THROWS_AS(vertex_directions(mesh, foreign), InvalidField);
  CHECK_THROWS_AS(angles_between(field, foreign), InvalidField);
}

TEST_CASE("comparison: a constant field in a plane is the same at vertices") {
  const auto mesh = mapped(jittered_grid(9, 7), [](const Vector& v) { return Vector(some_rotation() * v); }).mesh();
  const Vector direction = some_rotation() * Vector(0.6, -0.8, 0);
  const auto directions = vertex_directions(mesh, constant_field(mesh, direction));
  REQUIRE(directions.size() == mesh.vertices().size());
  for (const auto& found : directions) {
    CHECK(line_angle(vector(found), direction) < 1e-14);
    CHECK(vector(found).norm() == doctest::Approx(1).epsilon(1e-15));
  }
}

TEST_CASE("comparison: vertex directions are principal") {
  const auto mesh = mapped(sphere(2), [](const Vector& v) { return Vector(v.x(), 2 * v.y(), 0.5 * v.z()); }).mesh();
  const auto field = random_field(mesh, 6);
  std::vector<Eigen::Matrix3d> sums(mesh.vertices().size(), Eigen::Matrix3d::Zero());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto v = vector(field.directions()[t]);
    for (const auto k : mesh.triangles()[t]) sums[k] += mesh.triangle_areas()[t] * v * v.transpose();
  }
  const auto directions = vertex_directions(mesh, field);
  Random random(9);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const auto v = vector(directions[k]);
    const double greatest = v.dot(sums[k] * v);
    CHECK((sums[k] * v - greatest * v).norm() < 1e-13 * greatest);
    for (int i = 0; i < 20; ++i) {
      const double x = random.unit() - 0.5, y = random.unit() - 0.5, z = random.unit() - 0.5;
      const Vector other = Vector(x, y, z).normalized();
      CHECK(other.dot(sums[k] * other) <= greatest * (1 + 1e-12));
    }
  }
}

TEST_CASE("comparison: vertex directions of a smooth field approach it") {
  double previous = 0;
  for (const int subdivisions : {3, 4, 5}) {
    const auto mesh = sphere(subdivisions).mesh();
    const auto field = field_of(mesh, [](const Vector& c, const Vector&) { return eastwards(c); });
    const auto directions = vertex_directions(mesh, field);
    double worst = 0;
    for (std::size_t v = 0; v < directions.size(); ++v) {
      const auto place = vector(mesh.vertices()[v]);
      if (eastwards(place).norm() > 0.5) worst = std::max(worst, line_angle(vector(directions[v]), eastwards(place)));
    }
    if (previous > 0) CHECK(worst < 0.6 * previous);
    previous = worst;
  }
  CHECK(previous < degree);
}

TEST_CASE("comparison: vertices without a direction, or with two") {
  const auto mesh = grid(1, 1).mesh();  // triangles (0, 1, 3) and (0, 3, 2)
  const auto crossing =
      vertex_directions(mesh, OrientationField::from_triangle_vectors(mesh, std::vector<Vec3>{{1, 0, 0}, {0, 1, 0}}));
  CHECK(crossing == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}});
  const auto single =
      vertex_directions(mesh, OrientationField::from_triangle_vectors(mesh, std::vector<Vec3>{{1, 0, 0}, {0, 0, 0}}));
  CHECK(single == std::vector<Vec3>{{1, 0, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}});
}

TEST_CASE("comparison: signs mean nothing") {
  const auto mesh = torus(16, 9).mesh();
  const auto vectors = triangle_vectors(mesh, [](const Vector& c, const Vector&) { return Vector(c.y(), 1, c.x()); });
  const auto field = OrientationField::from_triangle_vectors(mesh, vectors);
  const auto flipped = OrientationField::from_triangle_vectors(mesh, negated(vectors, 11));
  CHECK(vertex_directions(mesh, field) == vertex_directions(mesh, flipped));
  CHECK(add_angular_noise(mesh, field, 0.3).directions() == add_angular_noise(mesh, flipped, 0.3).directions());
  for (const double angle : angles_between(field, flipped)) CHECK(angle == 0);
}

}  // namespace pectinate::test
