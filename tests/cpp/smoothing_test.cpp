// SPDX-License-Identifier: MIT
#include "pectinate/smoothing.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

#include "fields.hpp"
#include "pectinate/demo_atrium.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;
using detail::vector;

std::int32_t count_of(const SurfaceMesh& mesh) {
  return static_cast<std::int32_t>(mesh.triangle_count());
}

double normal_number(Random& random) {
  return std::sqrt(-2 * std::log(1 - random.unit())) * std::cos(2 * std::numbers::pi * random.unit());
}

OrientationField turned(const SurfaceMesh& mesh, const OrientationField& field, const auto& angle) {
  std::vector<Vec3> vectors(mesh.input_triangle_count());
  for (std::int32_t t = 0; t < count_of(mesh); ++t) {
    const Vector d = vector(field.directions()[t]), across = vector(mesh.triangle_normals()[t]).cross(d);
    const double a = angle(t);
    vectors[mesh.input_triangle()[t]] = detail::vec3(std::cos(a) * d + std::sin(a) * across);
  }
  return OrientationField::from_triangle_vectors(mesh, vectors);
}

/// Normal noise on every fibre, and some of them anywhere.
OrientationField noisy(const SurfaceMesh& mesh, const OrientationField& field, double deviation, double outlier_share) {
  Random random(3);
  return turned(mesh, field, [&](std::int32_t) {
    const double noise = deviation * normal_number(random), anywhere = std::numbers::pi * random.unit();
    return random.unit() < outlier_share ? anywhere : noise;
  });
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<double> angles(const OrientationField& a, const OrientationField& b) {
  std::vector<double> all;
  for (std::size_t t = 0; t < a.directions().size(); ++t) {
    all.push_back(line_angle(vector(a.directions()[t]), vector(b.directions()[t])));
  }
  return all;
}

double degrees(double angle) {
  return angle * 180 / std::numbers::pi;
}

Soup demo(double edge_length) {
  auto atrium = make_demo_atrium({.edge_length = edge_length});
  return {std::move(atrium.vertices), std::move(atrium.triangles)};
}

OrientationField demo_field(const SurfaceMesh& mesh, double edge_length) {
  return OrientationField::from_triangle_vectors(mesh, make_demo_atrium({.edge_length = edge_length}).directions);
}

/// Rings, which turn by a right angle over half a radius of 20.
OrientationField rings(const SurfaceMesh& mesh) {
  return field_of(mesh, [](const Vector& c, const Vector&) { return Vector(-c.y() - 20, c.x() + 20, 0); });
}

}  // namespace

TEST_CASE("noise of 10 degrees with outliers is brought down four-fold and more") {
  const SurfaceMesh plane = jittered_grid(90, 90, 0.3).mesh();  // the length is ten edges
  const auto truth = rings(plane), measured = noisy(plane, truth, 10 * std::numbers::pi / 180, 0.05);
  const double before = median(angles(measured, truth));
  CHECK(degrees(before) > 6);
  const auto result = smooth(plane, measured, {.length = 3});
  CHECK(median(angles(result.field, truth)) < before / 4);
}

TEST_CASE("a smooth field is left alone") {
  const SurfaceMesh mesh = jittered_grid(60, 60, 0.5).mesh();
  for (const double length : {0.5, 1.5}) {
    const auto result = smooth(mesh, rings(mesh), {.length = length});
    CHECK(degrees(*std::ranges::max_element(result.moved_angles)) < 0.5);
    CHECK(std::ranges::count(result.outliers, 1) == 0);
  }
  const SurfaceMesh plane = jittered_grid(30, 30).mesh();
  const auto constant = constant_field(plane, {1, 2, 0});
  const auto same = smooth(plane, constant);
  CHECK(*std::ranges::max_element(same.moved_angles) <= 1e-10);
}

TEST_CASE("single outliers are found and replaced, whatever stands around them") {
  const SurfaceMesh mesh = demo(1.5).mesh();
  const auto field = demo_field(mesh, 1.5);
  Random random(4);
  std::vector<bool> wrong(mesh.triangle_count());
  for (auto&& w : wrong) w = random.below(50) == 0;
  const auto measured = turned(mesh, field, [&](std::int32_t t) { return wrong[t] ? 0.9 : 0.0; });
  const auto result = smooth(mesh, measured, {.length = 4});
  std::vector<double> left;
  std::size_t missed = 0;
  for (std::int32_t t = 0; t < count_of(mesh); ++t) {
    if (!wrong[t]) continue;
    missed += result.outliers[t] == 0;
    left.push_back(line_angle(vector(result.field.directions()[t]), vector(field.directions()[t])));
  }
  CHECK(missed < left.size() / 50);
  CHECK(degrees(median(left)) < 2);
}

TEST_CASE("where fibres are of two opinions the slightly more common one prevails") {
  const SurfaceMesh mesh = grid(40, 40).mesh();
  const auto minority = [](std::int32_t t) { return t % 17 < 8; };
  const auto field =
      turned(mesh, constant_field(mesh, {1, 0, 0}), [&](std::int32_t t) { return minority(t) ? 0.7 : 0; });
  const auto result = smooth(mesh, field, {.length = 5, .outlier_angle = 0.17});
  for (std::int32_t t = 0; t < count_of(mesh); ++t) CHECK((result.outliers[t] == 1) == minority(t));
}

TEST_CASE("nothing passes a barrier") {
  const SurfaceMesh mesh = grid(40, 20, 0.5).mesh();
  std::vector<std::int32_t> label(mesh.triangle_count());
  const auto halves = turned(mesh, constant_field(mesh, {1, 0, 0}), [&](std::int32_t t) {
    label[t] = centre(mesh, t).x() < 10 ? 7 : -1;
    return label[t] == 7 ? 0.0 : std::numbers::pi / 3;
  });
  const auto apart = smooth(mesh, halves, {}, label), together = smooth(mesh, halves);
  CHECK(*std::ranges::max_element(apart.moved_angles) <= 1e-9);
  CHECK(*std::ranges::max_element(together.moved_angles) > 0.1);
}

TEST_CASE("missing fibres stay missing unless they are to be filled") {
  const SurfaceMesh mesh = grid(20, 20).mesh();
  auto vectors = triangle_vectors(mesh, [](const Vector&, const Vector&) { return Vector(2, 1, 0); });
  for (std::size_t t = 0; t < vectors.size(); t += 3) vectors[t] = {0, 0, 0};
  const auto field = OrientationField::from_triangle_vectors(mesh, vectors);
  const auto kept = smooth(mesh, field), filled = smooth(mesh, field, {.fill_missing = true});
  CHECK(filled.field.count(DirectionStatus::valid) == mesh.triangle_count());
  for (std::int32_t t = 0; t < count_of(mesh); ++t) {
    CHECK(kept.field.has_direction(t) == field.has_direction(t));
    CHECK(std::isnan(filled.moved_angles[t]) == !field.has_direction(t));
    CHECK(line_angle(vector(filled.field.directions()[t]), Vector(2, 1, 0)) <= 1e-9);
  }
}

TEST_CASE("over the greatest length fibres with a little noise become one, also beside components without any") {
  const SurfaceMesh mesh = together(jittered_grid(60, 60), moved(grid(60, 60), {70, 0, 0})).mesh();
  Random random(4);
  const auto field = field_of(mesh, [&](const Vector& at, const Vector&) -> Vector {
    const double angle = 0.5 + 0.1 * normal_number(random);
    return at.x() > 65 ? Vector::Zero() : Vector(std::cos(angle), std::sin(angle), 0);
  });
  const auto result = smooth(mesh, field, {.length = 10 * mesh.bounding_box_diagonal(), .fill_missing = true});
  const Vector one = vector(result.field.directions()[0]);
  CHECK(line_angle(one, Vector(std::cos(0.5), std::sin(0.5), 0)) < 0.01);
  for (std::int32_t t = 0; t < count_of(mesh); ++t) {
    if (!field.has_direction(t)) continue;
    CHECK(line_angle(vector(result.field.directions()[t]), one) < 1e-3);
  }
}

TEST_CASE("signs change nothing, and rotation and scale with length nothing but rounding") {
  const Soup soup = demo(3);
  const SurfaceMesh mesh = soup.mesh();
  const auto measured = noisy(mesh, demo_field(mesh, 3), 0.1, 0.02).directions();
  const auto field = OrientationField::from_triangle_vectors(mesh, measured);
  const auto expected = smooth(mesh, field, {.length = 5});
  std::vector<Vec3> reversed, rotated;
  const Eigen::Matrix3d rotation = some_rotation();
  for (const auto& d : measured) {
    reversed.push_back(detail::vec3(-vector(d)));
    rotated.push_back(detail::vec3(rotation * vector(d)));
  }
  const auto same = smooth(mesh, OrientationField::from_triangle_vectors(mesh, reversed), {.length = 5});
  CHECK(same.field.directions() == expected.field.directions());
  CHECK(same.moved_angles == expected.moved_angles);
  const SurfaceMesh other = mapped(soup, [&](const Vector& v) { return Vector(10 * (rotation * v)); }).mesh();
  const auto turned = smooth(other, OrientationField::from_triangle_vectors(other, rotated), {.length = 50});
  CHECK(turned.outliers == expected.outliers);
  for (std::int32_t t = 0; t < count_of(mesh); ++t) {
    CHECK(line_angle(vector(turned.field.directions()[t]), rotation * vector(expected.field.directions()[t])) <= 1e-8);
    CHECK(expected.moved_angles[t] ==
          doctest::Approx(line_angle(vector(expected.field.directions()[t]), vector(field.directions()[t]))));
  }
}

TEST_CASE("on surfaces without sides it does not matter where the seam runs, and nothing passes a barrier") {
  for (const Soup& soup : {moebius_strip(40, 5), klein_bottle(24, 14)}) {
    const SurfaceMesh mesh = soup.mesh();
    const auto vectors = random_field(mesh, 5).directions(), others = random_field(mesh, 6).directions();
    std::vector<std::int32_t> label;
    for (std::int32_t t = 0; t < count_of(mesh); ++t) label.push_back(centre(mesh, t).x() > 0 ? 1 : 0);
    const auto smoothed = [&](const SurfaceMesh& on, const std::vector<Vec3>& given) {
      return smooth(on, OrientationField::from_triangle_vectors(on, given), {.length = 0.4}, label).field.directions();
    };
    const auto expected = smoothed(mesh, vectors);
    const auto check_same = [&](const std::vector<Vec3>& directions, std::int32_t except) {
      for (std::int32_t t = 0; t < count_of(mesh); ++t) {
        if (label[t] != except) CHECK(line_angle(vector(directions[t]), vector(expected[t])) <= 1e-8);
      }
    };
    Random random(11);
    Soup wound = soup;
    for (auto& [a, b, c] : wound.triangles) {
      if (random.below(2) == 0) std::swap(a, b);
    }
    check_same(smoothed(wound.mesh(), vectors), -1);
    for (const std::int32_t changed : {0, 1}) {
      auto mixed = vectors;
      for (std::int32_t t = 0; t < count_of(mesh); ++t) {
        if (label[t] == changed) mixed[t] = others[t];
      }
      check_same(smoothed(mesh, mixed), changed);
    }
  }
}

TEST_CASE("surfaces of every kind are smoothed") {
  for (const Soup& soup : {one_triangle(), tetrahedron(), sphere(2), torus(14, 9), moebius_strip(30, 4),
                           klein_bottle(20, 12), together(one_triangle(), moved(grid(4, 4), {9, 0, 0}))}) {
    const SurfaceMesh mesh = soup.mesh();
    const auto result = smooth(mesh, random_field(mesh, 5), {.length = 0.4});
    CHECK(result.field.count(DirectionStatus::valid) == mesh.triangle_count());
    CHECK(std::ranges::all_of(result.moved_angles, [](double a) { return a >= 0 && a <= std::numbers::pi / 2; }));
  }
}

TEST_CASE("smoothing options out of range are refused") {
  const SurfaceMesh mesh = grid(3, 3).mesh();
  const auto field = constant_field(mesh, {1, 0, 0});
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const double diagonal = mesh.bounding_box_diagonal();
  for (const double length : {0.0, -1.0, nan, infinity, 1e300, 0.99e-6 * diagonal, 10.01 * diagonal}) {
    CHECK_THROWS_AS(smooth(mesh, field, {.length = length}), InvalidOption);
  }
  for (const double length : {1.01e-6 * diagonal, 9.99 * diagonal}) {
    CHECK(smooth(mesh, field, {.length = length}).field.count(DirectionStatus::valid) == mesh.triangle_count());
  }
  CHECK_THROWS_WITH_AS(smooth(mesh, field, {.length = 1e300}), doctest::Contains("length is 1e+300, but"),
                       InvalidOption);
  for (const double angle : {0.0, 2.0, nan}) {
    CHECK_THROWS_AS(smooth(mesh, field, {.outlier_angle = angle}), InvalidOption);
  }
  CHECK(smooth(mesh, field, {.outlier_angle = std::numbers::pi / 2}).outliers == std::vector<std::uint8_t>(18, 0));
  for (const std::size_t count : {1, 17, 19}) {
    CHECK_THROWS_AS(smooth(mesh, field, {}, std::vector<std::int32_t>(count)), InvalidOption);
  }
  CHECK_THROWS_AS(smooth(one_triangle().mesh(), field), InvalidField);
}

}  // namespace pectinate::test
