// SPDX-License-Identifier: MIT
#include "detail/implicit_surface.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>

#include "detail/atria_anatomy.hpp"
#include "detail/band.hpp"
#include "detail/bent_cone.hpp"
#include "detail/random.hpp"

namespace pectinate::detail {
namespace {

using Function = std::function<Sample(const Vector&)>;

Vector random_point(Random& random, const Box& box) {
  Vector point;
  for (int axis = 0; axis < 3; ++axis)
    point[axis] = box.lower[axis] + (box.upper[axis] - box.lower[axis]) * random.unit();
  return point;
}

/// The gradient against differences of the value.
void check_gradient(const Function& function, const Vector& point) {
  constexpr double step = 1e-6;
  Vector differences;
  for (int axis = 0; axis < 3; ++axis) {
    const Vector shift = step * Vector::Unit(axis);
    differences[axis] = (function(point + shift).value - function(point - shift).value) / (2 * step);
  }
  CHECK((function(point).gradient - differences).norm() < 1e-4);
}

/// About the origin.
BentCone quarter_circle() {
  return {{Vector(10, 0, 0), Vector(0, 10, 0), 3, 1}, Vector(0, 1, 0)};
}

TEST_CASE("the functions of the atria have the gradients they tell") {
  Random random(1);
  for (const Chamber& chamber : {make_left_chamber(), make_right_chamber(), make_bachmann_bundle()}) {
    const ImplicitSurface surface{chamber.function, {}, chamber.bounds};
    for (int i = 0; i < 200; ++i) {
      const Vector on_surface = project(surface, random_point(random, chamber.bounds));
      if (std::abs(chamber.function(on_surface).value) > 1e-9) continue;  // a start from which Newton does not arrive
      check_gradient(chamber.function, on_surface);
      check_gradient(chamber.function, on_surface - 1.5 * chamber.function(on_surface).gradient);
      CHECK(chamber.function(on_surface).gradient.norm() > 0.3);
      CHECK(chamber.function(on_surface).gradient.norm() < 1.2);
    }
  }
}

TEST_CASE("the zero sets lie in their bounds") {
  Random random(2);
  for (const Chamber& chamber : {make_left_chamber(), make_right_chamber()}) {
    const auto& [lower, upper] = chamber.bounds;
    for (int i = 0; i < 3000; ++i) {
      Vector point = random_point(random, chamber.bounds);
      const int axis = i % 3;
      point[axis] = i % 2 == 0 ? lower[axis] : upper[axis];
      CHECK(chamber.function(point).value > 0);
    }
  }
}

TEST_CASE("a bent cone is a ball along an arc") {
  const BentCone quarter = quarter_circle();
  for (int i = 0; i <= 90; i += 10) {
    const double angle = i * std::numbers::pi / 180, share = i / 90.0;
    const double radius = 3 - 2 * share * share * (3 - 2 * share);
    const Vector out(std::cos(angle), std::sin(angle), 0);
    CHECK(quarter.sample(10 * out).value == doctest::Approx(-radius));
    CHECK(std::abs(quarter.sample((10 + radius) * out).value) < 1e-12);
    CHECK(std::abs(quarter.sample(10 * out + radius * Vector::UnitZ()).value) < 1e-12);
  }
  CHECK(std::abs(quarter.sample({10, -3, 0}).value) < 1e-12);  // the caps
  CHECK(std::abs(quarter.sample({-1, 10, 0}).value) < 1e-12);
  Random random(3);
  const auto [lower, upper] = quarter.bounds();
  for (const Vector& reached : {Vector(13, 0, 0), Vector(10, -3, 0), Vector(0, 11, 0), Vector(-1, 10, 0)}) {
    CHECK((lower.array() <= reached.array()).all());
    CHECK((reached.array() <= upper.array()).all());
  }
  for (int i = 0; i < 500; ++i) {
    const Vector point = random_point(random, {lower, upper});
    const double angle = std::atan2(point.y(), point.x()), from_origin = std::hypot(point.x(), point.y());
    const bool at_a_seam = std::abs(angle) < 1e-3 || std::abs(angle - std::numbers::pi / 2) < 1e-3;
    if (!at_a_seam && from_origin > 2 && quarter.sample(point).value > -0.5)
      check_gradient([&](const Vector& p) { return quarter.sample(p); }, point);
  }
}

TEST_CASE("an intersection is the complement of the union of complements") {
  const Sample a{0.3, Vector(1, 0, 0)}, b{0.1, Vector(0, 1, 0)}, far{-9, Vector(0, 0, 1)};
  CHECK(smooth_intersection(a, far, 2).value == 0.3);
  CHECK(smooth_intersection(a, far, 2).gradient == Vector(1, 0, 0));
  CHECK(smooth_intersection(a, b, 2).value > 0.3);  // rounded: less is left
  CHECK(smooth_intersection(a, b, 2).value == smooth_intersection(b, a, 2).value);
  const Sample rounded = smooth_intersection({0, Vector(1, 0, 0)}, {0, Vector(0, 1, 0)}, 3);
  CHECK(rounded.value == doctest::Approx(0.5));
  CHECK(rounded.gradient.isApprox(Vector(0.5, 0.5, 0)));
}

TEST_CASE("points drawn to a curved border lie on the surface and on the cut") {
  const Chamber chamber = make_left_chamber();
  const ImplicitSurface surface{chamber.function, {}, chamber.bounds};
  const auto& fossa = chamber.openings.back();
  REQUIRE(fossa.name == "fossa_ovalis");
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    Vector off(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5);
    const Vector start = fossa.cut.centre + 8 * off.normalized();
    const Vector drawn = project_to_border(surface, fossa.cut, start);
    const bool beside_the_axis = std::abs(off.normalized().dot(Vector(0.74, 0.67, 0).normalized())) < 0.7;
    if (!beside_the_axis) continue;
    CHECK(std::abs(chamber.function(drawn).value) < 1e-10);
    CHECK(std::abs(fossa.cut.height(drawn)) < 1e-10);
    CHECK(fossa.cut.function(drawn).gradient.norm() == doctest::Approx(1));
  }
}

TEST_CASE("a band's curve lies on the surface and passes its points") {
  const Function sphere = [](const Vector& p) { return Sample{p.norm() - 10, p.normalized()}; };
  const std::vector<Vector> points{{11, 0, 0}, {8, 8, 0}, {0, 9, 1}};
  const Band band = lay_band(sphere, points, {2, 3, 1});
  double longest = 0;
  for (const auto& piece : band.pieces) {
    CHECK(piece.start.norm() == doctest::Approx(10));
    CHECK(piece.end.norm() == doctest::Approx(10));
    longest = std::max(longest, (piece.end - piece.start).norm());
  }
  CHECK(longest < 1);
  CHECK(sample(band, 10 * points[1].normalized()).value == doctest::Approx(-3));
  CHECK(sample(band, 10 * points[2].normalized()).value == doctest::Approx(-1).epsilon(0.01));
  CHECK(sample(band, Vector(10, -2, 0)).value == doctest::Approx(0).epsilon(0.05));
  CHECK(sample(band, Vector(0, 0, -10)).value > 5);
}

}  // namespace
}  // namespace pectinate::detail
