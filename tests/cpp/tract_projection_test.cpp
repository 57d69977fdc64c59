// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "detail/capsule.hpp"
#include "detail/shortest_path.hpp"
#include "detail/surface_curve.hpp"
#include "pectinate/demo_atrium.hpp"
#include "pectinate/errors.hpp"
#include "tracts.hpp"

namespace pectinate::test {
namespace {

using detail::vec3;
using detail::Vector;
using detail::vector;

Constraints only(const SurfaceMesh& mesh, const Tract& tract) {
  return make_constraints(mesh, {&tract, 1}, {}, {std::numeric_limits<double>::infinity()});
}

ProjectedTract projected(const SurfaceMesh& mesh, const std::vector<Vec3>& points) {
  const auto result = only(mesh, tract(points)).tracts.at(0);
  check_projected(mesh, result);
  return result;
}

/// A jittered grid without the triangles whose centres are in a box.
Soup grid_with_hole(int columns, int rows, const Vector& low, const Vector& high, std::uint64_t seed) {
  Soup soup = jittered_grid(columns, rows, 1, seed);
  std::erase_if(soup.triangles, [&](const Triangle& t) {
    const Vector c = (vector(soup.vertices[t[0]]) + vector(soup.vertices[t[1]]) + vector(soup.vertices[t[2]])) / 3;
    return c.x() > low.x() && c.x() < high.x() && c.y() > low.y() && c.y() < high.y();
  });
  return soup;
}

Soup atrium() {
  const auto demo = make_demo_atrium({3.0});
  return {demo.vertices, demo.triangles};
}

/// Another way to the same distance: to the plane where the foot is inside, else to the nearest side.
double distance_to_triangle(const SurfaceMesh& mesh, std::int32_t t, const Vector& point) {
  const Vector normal = vector(mesh.triangle_normals()[t]);
  if (barycentric(mesh, t, point).minCoeff() >= 0) return std::abs(normal.dot(point - corner(mesh, t, 0)));
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    least = std::min(least, detail::distance_to_segment(point, corner(mesh, t, k), corner(mesh, t, k + 1)));
  }
  return least;
}

double distance_to_surface(const SurfaceMesh& mesh, const Vector& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    least = std::min(least, distance_to_triangle(mesh, t, point));
  }
  return least;
}

Vector some_turn(const Vector& v) {
  return some_rotation() * v + Vector(3, -20, 7);
}

std::vector<Vec3> random_polyline(const SurfaceMesh& mesh, Random& random) {
  std::vector<Vec3> points;
  const double scale = mesh.bounding_box_diagonal();
  const double step = scale * std::pow(10, -3 * random.unit());
  Vector place = random_place(mesh, random);
  const auto count = 2 + random.below(8);
  for (std::size_t i = 0; i < count; ++i) {
    if (random.below(3) == 0) place = vector(nearest_surface_points(mesh, std::vector{vec3(place)})[0].point);
    points.push_back(vec3(place));
    if (random.below(10) == 0) points.push_back(points.back());
    place += step * Vector(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5);
    if (random.below(4) == 0) place = random_place(mesh, random);
  }
  if (random.below(4) == 0) points.push_back(points.front());
  return points;
}

}  // namespace

TEST_CASE("nearest points agree with a search through all triangles") {
  Random random(1);
  const Soup flattened = mapped(sphere(3), [](const Vector& v) { return Vector(v.x(), v.y(), 1e-3 * v.z()); });
  for (const auto& soup : {jittered_grid(8, 7), sphere(3), torus(20, 9), klein_bottle(24, 12), flattened, tetrahedron(),
                           one_triangle(), three_on_an_edge()}) {
    const auto mesh = soup.mesh();
    const double scale = mesh.bounding_box_diagonal();
    std::vector<Vec3> points;
    for (int i = 0; i < 100; ++i) {
      const double away = i % 2 * scale * std::pow(10, 3 - 6 * random.unit());
      const Vector offset(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5);
      points.push_back(vec3(random_place(mesh, random) + away * offset));
    }
    const auto nearest = nearest_surface_points(mesh, points);
    REQUIRE(nearest.size() == points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto& [t, point, distance] = nearest[i];
      const double tolerance = 1e-12 * (scale + distance);
      CHECK(std::abs(distance - distance_to_surface(mesh, vector(points[i]))) < tolerance);
      CHECK(std::abs(distance - distance_to_triangle(mesh, t, vector(points[i]))) < tolerance);
      CHECK((vector(point) - vector(points[i])).norm() == doctest::Approx(distance).epsilon(1e-14));
      CHECK(lies_in(mesh, t, vector(point)));
    }
  }
}

TEST_CASE("of equally near triangles the first is the nearest") {
  Random random(2);
  for (const auto& soup : {grid(5, 4), sphere(2), tetrahedron(), mapped(sphere(3), some_turn)}) {
    const auto mesh = soup.mesh();
    const TractProjector projector(mesh);
    for (std::size_t e = 0; e < mesh.edges().size(); ++e) {
      const auto [a, b] = mesh.edges()[e];
      const auto sides = mesh.edge_triangles(static_cast<std::int32_t>(e));
      const double share = 0.25 * static_cast<double>(1 + random.below(3));
      const Vector point = (1 - share) * vector(mesh.vertices()[a]) + share * vector(mesh.vertices()[b]);
      const Vector outside = point + 1e-3 * (vector(mesh.triangle_normals()[sides.front()]) +
                                             vector(mesh.triangle_normals()[sides.back()]));
      for (const Vector& place : {point, outside}) {
        const auto nearest = projector.nearest_surface_points(std::vector{vec3(place)})[0];
        CHECK(nearest.triangle == *std::min_element(sides.begin(), sides.end()));
      }
    }
    for (std::size_t v = 0; v < mesh.vertices().size(); ++v) {
      const auto nearest = projector.nearest_surface_points(std::vector{mesh.vertices()[v]})[0];
      const auto holds = [&](const Triangle& t) {
        return std::find(t.begin(), t.end(), static_cast<std::int32_t>(v)) != t.end();
      };
      const auto first = std::find_if(mesh.triangles().begin(), mesh.triangles().end(), holds);
      CHECK(nearest.triangle == first - mesh.triangles().begin());
      CHECK(nearest.point == mesh.vertices()[v]);
      CHECK(nearest.distance == 0);
    }
  }
}

TEST_CASE("nearest points: what is not finite or too far is refused by number") {
  const auto mesh = sphere(2).mesh();
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(nearest_surface_points(mesh, {}).empty());
  CHECK_NOTHROW(nearest_surface_points(mesh, std::vector<Vec3>{{1e9, 0, 0}}));
  for (const double bad : {std::nan(""), infinity, -infinity, 1e11, 1e200, 1e308}) {
    CHECK_THROWS_WITH_AS(nearest_surface_points(mesh, std::vector<Vec3>{{0, 0, 0}, {0, bad, 0}}),
                         doctest::Contains("point 1 "), InvalidOption);
  }
}

TEST_CASE("projection: any polyline on any surface, and backwards the same bytes") {
  Random random(3);
  const Soup hole = grid_with_hole(16, 16, {7, 3, 0}, {9, 14, 0}, 1);
  for (const auto& soup : {grid(12, 12), jittered_grid(12, 12), hole, sphere(3), torus(24, 12), moebius_strip(30, 4),
                           klein_bottle(30, 16), cylinder(24, 12, 1, 2), tetrahedron(), atrium()}) {
    const auto mesh = soup.mesh();
    for (int i = 0; i < 60; ++i) {
      const Tract drawn = tract(random_polyline(mesh, random));
      Constraints constraints;
      try {
        constraints = only(mesh, drawn);
      } catch (const InvalidOption&) {
        CHECK_THROWS_WITH_AS(only(mesh, backwards(drawn)), doctest::Contains("two distinct points"), InvalidOption);
        continue;
      }
      const auto& there = constraints.tracts[0];
      check_projected(mesh, there);
      const std::set<std::int32_t> crossed(there.triangles.begin(), there.triangles.end());
      CHECK(constrained_triangles(constraints) == std::vector(crossed.begin(), crossed.end()));

      const auto again = only(mesh, backwards(drawn));
      auto back = again.tracts[0];
      std::reverse(back.points.begin(), back.points.end());
      std::reverse(back.triangles.begin(), back.triangles.end());
      CHECK(back.points == there.points);
      CHECK(back.triangles == there.triangles);
      CHECK(back.greatest_distance == there.greatest_distance);
      CHECK(back.greatest_detour == doctest::Approx(there.greatest_detour).epsilon(1e-12));
      CHECK(again.conflicts.empty() == constraints.conflicts.empty());
      if (!constraints.conflicts.empty()) continue;
      for (std::size_t k = 0; k < crossed.size(); ++k) {
        CHECK(line_angle(vector(again.triangles[k].direction), vector(constraints.triangles[k].direction)) < 1e-12);
      }
    }
  }
}

TEST_CASE("projection: the given points are on the curve, in their order") {
  Random random(4);
  for (const auto& soup : {jittered_grid(9, 9), sphere(3), atrium()}) {
    const auto mesh = soup.mesh();
    std::vector<Vec3> given(12);
    for (auto& point : given) point = vec3(1.001 * random_place(mesh, random));
    const auto nearest = nearest_surface_points(mesh, given);
    const auto curve = projected(mesh, given);
    double greatest = 0;
    auto next = curve.points.begin();
    for (const auto& [t, point, distance] : nearest) {
      next = std::find(next, curve.points.end(), point);
      CHECK(next != curve.points.end());
      greatest = std::max(greatest, distance);
    }
    CHECK(curve.points.front() == nearest.front().point);
    CHECK(curve.points.back() == nearest.back().point);
    CHECK(curve.greatest_distance == greatest);
  }
}

TEST_CASE("projection: in a plane it is the polyline itself") {
  Random random(5);
  const auto mesh = jittered_grid(15, 15).mesh();
  const TractProjector projector(mesh);
  for (int i = 0; i < 50; ++i) {
    std::vector<Vec3> given(5);
    for (auto& point : given) point = {0.1 + 14.8 * random.unit(), 0.1 + 14.8 * random.unit(), 0};
    const auto curve = projected(mesh, given);
    CHECK(length_of(curve.points) == doctest::Approx(length_of(given)).epsilon(1e-12));
    CHECK(curve.greatest_detour == doctest::Approx(1).epsilon(1e-12));
    // Every triangle with a point of the polyline well inside it is crossed.
    const std::set<std::int32_t> crossed(curve.triangles.begin(), curve.triangles.end());
    for (std::size_t k = 1; k < given.size(); ++k) {
      for (int j = 0; j <= 100; ++j) {
        const Vector point = (1 - 0.01 * j) * vector(given[k - 1]) + 0.01 * j * vector(given[k]);
        const auto t = projector.nearest_surface_points(std::vector{vec3(point)})[0].triangle;
        if (barycentric(mesh, t, point).minCoeff() > 1e-9) CHECK(crossed.contains(t));
      }
    }
  }
}

TEST_CASE("projection: how finely a tract is drawn hardly matters") {
  const auto mesh = sphere(5).mesh();
  const auto arc = [](int steps) {
    std::vector<Vec3> points;
    for (int i = 0; i <= steps; ++i) {
      const double angle = 0.1 + 2.0 * i / steps;
      points.push_back({0.8 * std::cos(angle), 0.8 * std::sin(angle), 0.6});
    }
    return points;
  };
  const double length = 0.8 * 2.0;
  for (const int steps : {8, 64, 512, 4096}) {
    const auto curve = projected(mesh, arc(steps));
    CHECK(length_of(curve.points) == doctest::Approx(length).epsilon(0.01));
    CHECK(curve.greatest_detour < 1.01);
  }
}

TEST_CASE("projection: one long step on a sphere is the great circle") {
  const auto mesh = sphere(5).mesh();
  Random random(6);
  for (const double angle : {0.3, 1.0, 2.0, 2.6}) {
    for (int i = 0; i < 10; ++i) {
      const Vector a = random_place(mesh, random).normalized();
      const Vector across = a.unitOrthogonal();
      const Vector b = std::cos(angle) * a + std::sin(angle) * across;
      const auto curve = projected(mesh, {vec3(a), vec3(b)});
      CHECK(length_of(curve.points) == doctest::Approx(angle).epsilon(0.003));
      for (const auto& point : curve.points) CHECK(std::abs(vector(point).dot(a.cross(across))) < 0.05);
    }
  }
}

TEST_CASE("projection: opposite points of a tube are joined by half a turn") {
  const auto mesh = cylinder(60, 30, 1, 3).mesh();
  const auto curve = projected(mesh, {{1, 0, 1.5}, {-1, 0, 1.5}});
  CHECK(length_of(curve.points) == doctest::Approx(std::numbers::pi).epsilon(0.02));
  CHECK(curve.greatest_detour == doctest::Approx(std::numbers::pi / 2).epsilon(0.02));
}

TEST_CASE("projection: around a hole, about as short as can be") {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    // The hole reaches to within the jitter of 4.7 and 15.3 across, and up to about 11.
    const auto mesh = grid_with_hole(20, 20, {5, -1, 0}, {15, 11, 0}, seed).mesh();
    REQUIRE(mesh.boundary_loops().size() == 1);
    const auto curve = projected(mesh, {{2, 2, 0}, {18, 2, 0}});
    const double taut = 2 * std::hypot(3, 9) + 10;  // over the corners of the box
    CHECK(length_of(curve.points) > 0.9 * taut);
    CHECK(length_of(curve.points) < 1.1 * taut);
    CHECK(curve.greatest_detour == doctest::Approx(length_of(curve.points) / 16).epsilon(1e-9));
  }
}

TEST_CASE("projection: the locally shortest path is straight where the strip allows it") {
  Random random(7);
  // In a strip of one row every triangle is passed, and a straight line stays inside.
  const auto strip =
      mapped(jittered_grid(30, 1), [](const Vector& v) {
        return Vector(std::cos(0.2 * v.x()), v.y(), std::sin(0.2 * v.x()));  // rolled up: prisms unfold exactly
      }).mesh();
  const double width = 2 * std::sin(0.1);
  for (int i = 0; i < 20; ++i) {
    const double y0 = random.unit(), y1 = random.unit();
    const detail::Place a{0, Vector(1, y0, 0)}, b{59, Vector(std::cos(6.0), y1, std::sin(6.0))};
    const detail::Place start{1, a.point}, goal{58, b.point};
    const auto path = detail::shortest_path(strip, start, goal);
    CHECK(detail::curve_length(a.point, path) == doctest::Approx(std::hypot(30 * width, y1 - y0)).epsilon(1e-12));
    CHECK(detail::path_within(strip, start, goal, 100 * width).has_value());
    CHECK(!detail::path_within(strip, start, goal, 29 * width).has_value());
  }
}

TEST_CASE("projection: a tract inside one triangle") {
  const auto mesh = grid(3, 3).mesh();
  const auto constraints = only(mesh, tract({{1.5, 1.1, 0}, {1.6, 1.2, 0.001}, {1.7, 1.3, 0}}));
  REQUIRE(constraints.triangles.size() == 1);
  CHECK(constraints.triangles[0].triangle == 8);
  CHECK(line_angle(vector(constraints.triangles[0].direction), Vector(1, 1, 0)) < 1e-12);
  CHECK(constraints.tracts[0].points.size() == 3);
  CHECK(constraints.tracts[0].greatest_distance == doctest::Approx(0.001));
}

TEST_CASE("projection: repeated points count once, wherever they are") {
  const auto mesh = jittered_grid(5, 5).mesh();
  const Vec3 a{0.3, 0.4, 0}, b{2.2, 1.9, 0}, c{4.4, 4.1, 0}, vertex = mesh.vertices()[14];
  const auto plain = projected(mesh, {a, b, vertex, c});
  const auto repeated = projected(mesh, {a, a, b, b, b, vertex, vertex, c, c});
  CHECK(repeated.points == plain.points);
  CHECK(repeated.triangles == plain.triangles);
}

TEST_CASE("projection: along edges and through vertices") {
  const auto mesh = grid(6, 6).mesh();
  for (const auto& points : std::vector<std::vector<Vec3>>{{{0, 0, 0}, {6, 6, 0}},
                                                           {{0, 3, 0}, {6, 3, 0}},
                                                           {{3, 0, 0}, {3, 6, 0}},
                                                           {{0, 6, 0}, {6, 0, 0}},
                                                           {{0, 0, 0}, {2, 1, 0}, {6, 3, 0}},
                                                           {{0, 0, 0}, {6, 0, 0}, {6, 6, 0}, {0, 6, 0}, {0, 0, 0}}}) {
    const auto curve = projected(mesh, points);
    CHECK(length_of(curve.points) == doctest::Approx(length_of(points)).epsilon(1e-8));
    CHECK(curve.greatest_detour == doctest::Approx(1).epsilon(1e-8));
  }
}

TEST_CASE("projection: a closed tract around a Moebius strip") {
  const auto mesh = moebius_strip(40, 4).mesh();
  std::vector<Vec3> points;
  for (int i = 0; i <= 17; ++i) points.push_back({2 * std::cos(turn(i, 17)), 2 * std::sin(turn(i, 17)), 0});
  const auto curve = projected(mesh, points);
  CHECK(length_of(curve.points) == doctest::Approx(4 * std::numbers::pi).epsilon(0.02));
  CHECK((vector(curve.points.front()) - vector(curve.points.back())).norm() < 1e-12);
}

TEST_CASE("projection: the farther the detour, the clearer the report") {
  // Two walls 0.2 apart, joined at one end: a point that comes to the wrong wall makes a long way.
  Soup soup = grid(20, 4);
  soup = mapped(std::move(soup),
                [](const Vector& v) { return v.x() <= 10 ? v : Vector(20 - v.x(), v.y(), v.x() <= 10 ? 0 : 0.2); });
  const auto mesh = soup.mesh();
  CHECK(projected(mesh, {{2, 2, 0.01}, {3, 2, 0.01}, {4, 2, 0.02}}).greatest_detour == doctest::Approx(1));
  const auto wrong = projected(mesh, {{2, 2, 0.01}, {3, 2, 0.19}, {4, 2, 0.02}});
  CHECK(wrong.greatest_detour > 10);
}

TEST_CASE("projection: errors name the tract and the point") {
  const auto mesh = together(grid(4, 4), moved(grid(4, 4), {0, 0, 10})).mesh();
  const auto message = [&](const Tract& drawn) {
    const std::vector<Tract> tracts{tract({{1, 1, 0}, {2, 2, 0}}), drawn};
    try {
      make_constraints(mesh, tracts, {});
    } catch (const InvalidOption& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto named = [](std::vector<Vec3> points) { return Tract{"Bachmann", std::move(points), hard}; };
  const double infinity = std::numeric_limits<double>::infinity();
  CHECK(message(named({{1, 1, 0}, {2, 1, 0}})).empty());
  CHECK(message(named({})) ==
        "tract 1 \"Bachmann\" has fewer than two distinct points on the surface, but needs two for a direction");
  CHECK(message(tract({{1, 1, 0}})).starts_with("tract 1 has fewer than two distinct points"));
  CHECK(message(tract({{1, 1, 0}, {1, 1, 0}})).starts_with("tract 1 has fewer than two distinct points"));
  CHECK(message(tract({{1, 1, 0.01}, {1, 1, 0}})).starts_with("tract 1 has fewer than two distinct points"));
  CHECK(message(tract({{1, 1, 0}, {1 + 1e-10, 1, 0}})).starts_with("tract 1 has fewer than two distinct points"));
  for (const double bad : {std::nan(""), infinity, -infinity}) {
    CHECK(message(named({{1, 1, 0}, {2, 1, 0}, {bad, 1, 0}})) == "tract 1 \"Bachmann\": point 2 is not finite");
  }
  for (const double far : {0.2, 1e3, 1e12, 1e200, 1e308}) {
    CHECK(message(named({{1, 1, 0}, {2, 1, -far}})).starts_with("tract 1 \"Bachmann\": point 1 is "));
  }
  CHECK(message(named({{1, 1, 0}, {2, 1, -0.5}})).find("point 1 is 0.5 away from the surface") != std::string::npos);
  CHECK(message(named({{1, 1, 0}, {2, 1, 0}, {2, 1, 10}})).find("points 1 and 2 lie on different components") !=
        std::string::npos);
  // Across a cut at an edge with three triangles there is no surface.
  const auto fins = three_on_an_edge().mesh();
  CHECK_THROWS_WITH_AS(only(fins, tract({{0.3, 0, 0.3}, {-0.1, 0.2, 0.3}})), doctest::Contains("different components"),
                       InvalidOption);
}

}  // namespace pectinate::test
