// SPDX-License-Identifier: MIT
#include "pectinate/reference_frame.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <limits>

#include "disks.hpp"
#include "fields.hpp"
#include "pectinate/demo_atrium.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;
using detail::vector;

const bool without_cgal = !has_parameterization();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double pi = std::numbers::pi;

void check_orthonormal(const SurfaceMesh& mesh, const ReferenceFrame& frame) {
  REQUIRE(frame.longitudinal.size() == mesh.triangle_count());
  REQUIRE(frame.transverse.size() == mesh.triangle_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Vector along = vector(frame.longitudinal[t]), across = vector(frame.transverse[t]);
    const Vector normal = vector(mesh.triangle_normals()[t]);
    CHECK(std::abs(along.norm() - 1) < 1e-12);
    CHECK(std::abs(along.dot(normal)) < 1e-12);
    CHECK((normal.cross(along) - across).norm() < 1e-12);
  }
}

bool is_constant(const SurfaceMesh& mesh, const ReferenceFrame& frame, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles()[t];
  return frame.u[a] == frame.u[b] && frame.u[b] == frame.u[c];
}

/// What is true of every frame: u rises along e_l where it varies, and has no critical point.
void check_frame(const SurfaceMesh& mesh, const ReferenceFrame& frame) {
  check_orthonormal(mesh, frame);
  CHECK(frame.critical_points.empty());
  for (const double u : frame.u) CHECK((u >= 0 && u <= 1));
  std::vector<std::int32_t> constant;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    if (is_constant(mesh, frame, t)) {
      constant.push_back(t);
      continue;
    }
    // Along a side u changes as the side goes along e_l, and not as it goes along e_t.
    double slope = 0;
    for (int k = 0; k < 3; ++k) {
      const Vector side = corner(mesh, t, k + 1) - corner(mesh, t, k);
      const double along = side.dot(vector(frame.longitudinal[t]));
      if (std::abs(along) < 0.3 * side.norm()) continue;
      const double rise = frame.u[mesh.triangles()[t][(k + 1) % 3]] - frame.u[mesh.triangles()[t][k]];
      CHECK(rise / along > 0);
      if (slope != 0) CHECK(rise / along == doctest::Approx(slope).epsilon(1e-6));
      slope = rise / along;
    }
  }
  CHECK(frame.borrowed_triangles == constant);
}

ReferenceFrame frame_of(const SurfaceMesh& mesh, const ReferenceFrameOptions& options = {}) {
  return make_reference_frame(mesh, parameterize(mesh), options);
}

/// A direction in the triangle, in the basis of one of its sides: alike in both triangles that meet there if one is
/// unfolded into the other's plane.
Eigen::Vector2d at_side(const SurfaceMesh& mesh, std::int32_t t, const Vector& side, const Vec3& direction) {
  const Vector left = vector(mesh.triangle_normals()[t]).cross(side);
  return Eigen::Vector2d(vector(direction).dot(side), vector(direction).dot(left)) / side.norm();
}

void check_same_unfolded(const SurfaceMesh& mesh, const ReferenceFrame& frame, std::int32_t t, std::int32_t other) {
  for (int k = 0; k < 3; ++k) {
    if (mesh.neighbour(t, k).triangle != other) continue;
    const Vector side = corner(mesh, t, k + 1) - corner(mesh, t, k);
    const Eigen::Vector2d difference =
        at_side(mesh, t, side, frame.longitudinal[t]) - at_side(mesh, other, side, frame.longitudinal[other]);
    CHECK(difference.norm() < 1e-12);
    return;
  }
  FAIL("not neighbours");
}

/// The greatest difference between u and log r on an annulus.
double logarithm_error(int around) {
  const auto mesh = equilateral_annulus(around).mesh();
  const auto frame = frame_of(mesh, {.inner_loop = 1});
  check_frame(mesh, frame);
  const double inner_logarithm = -pi / (2 * std::sqrt(3));
  double error = 0;
  for (std::size_t v = 0; v < mesh.vertices().size(); ++v) {
    const double expected = 1 - std::log(vector(mesh.vertices()[v]).norm()) / inner_logarithm;
    error = std::max(error, std::abs(frame.u[v] - expected));
  }
  return error;
}

/// annulus(24, 4, 1, 2) as it lies, halved: a map onto the disk that needs no solver.
Parameterization halved(const SurfaceMesh& mesh) {
  Parameterization disk{{}, 0, 0, {{0, 0}, {0, 0}}, {}, {}};
  for (const auto& [x, y, z] : mesh.vertices()) disk.points.push_back({x / 2, y / 2});
  return disk;
}

struct Framed {
  SurfaceMesh mesh;
  ReferenceFrame frame;
};

Framed framed_dome() {
  auto mesh = with_holes(bumpy_disk(8, 7), 48, 2, 7).mesh();
  auto frame = frame_of(mesh, {.inner_loop = 1});
  return {std::move(mesh), std::move(frame)};
}

}  // namespace

TEST_CASE("frame: u is log r on an annulus, to second order" * doctest::skip(without_cgal)) {
  double last = logarithm_error(24);
  CHECK(last < 2e-2);
  for (const int around : {48, 96, 192}) {
    const double error = logarithm_error(around);
    CHECK(std::log2(last / error) == doctest::Approx(2).epsilon(0.05));
    last = error;
  }
}

TEST_CASE("frame: e_l is radial and e_t turns left on an annulus" * doctest::skip(without_cgal)) {
  const auto mesh = equilateral_annulus(96).mesh();
  const auto frame = frame_of(mesh, {.inner_loop = 1});
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    const Vector outwards = centre(mesh, t).normalized();
    CHECK(vector(frame.longitudinal[t]).dot(outwards) > std::cos(0.02));
    CHECK(vector(frame.transverse[t]).dot(Vector::UnitZ().cross(outwards)) > std::cos(0.02));
  }
}

TEST_CASE("frame: with nothing inside, u is (1 + x) / 2" * doctest::skip(without_cgal)) {
  const auto mesh = jittered_disk(8, 4).mesh();
  const auto frame = frame_of(mesh);
  check_frame(mesh, frame);
  for (std::size_t v = 0; v < mesh.vertices().size(); ++v) {
    CHECK(std::abs(frame.u[v] - (1 + mesh.vertices()[v][0]) / 2) < 1e-12);
  }
  for (const auto& along : frame.longitudinal) CHECK((vector(along) - Vector::UnitX()).norm() < 1e-10);
}

TEST_CASE("frame: no critical point on bumpy disks with holes" * doctest::skip(without_cgal)) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    const auto mesh = with_holes(bumpy_disk(14, seed), 84, 4, seed).mesh();
    const auto map = parameterize(mesh);
    check_frame(mesh, make_reference_frame(mesh, map));
    for (std::int32_t loop = 1; loop < static_cast<std::int32_t>(mesh.boundary_loops().size()); ++loop) {
      const auto frame = make_reference_frame(mesh, map, {.inner_loop = loop});
      check_frame(mesh, frame);
      for (const auto v : mesh.boundary_loops()[0].vertices) CHECK(frame.u[v] == 1);
      for (const auto v : mesh.boundary_loops()[loop].vertices) CHECK(frame.u[v] == 0);
    }
    const auto inner = mesh.vertices().size() / 2;
    const auto frame = make_reference_frame(mesh, map, {.inner_point = mesh.vertices()[inner]});
    check_frame(mesh, frame);
    CHECK(std::count(frame.u.begin(), frame.u.end(), 0.0) == 1);
    CHECK(frame.u[inner] == 0);
  }
}

TEST_CASE("frame: no critical point on the demo atrium" * doctest::skip(without_cgal)) {
  const auto atrium = make_demo_atrium({2});
  const SurfaceMesh mesh(atrium.vertices, atrium.triangles);
  const auto map = parameterize(mesh);
  check_frame(mesh, make_reference_frame(mesh, map));
  check_frame(mesh, make_reference_frame(mesh, map, {.inner_point = Vec3{0, 0, 0}}));
  for (const std::int32_t loop : {1, 2, 3, 4}) check_frame(mesh, make_reference_frame(mesh, map, {.inner_loop = loop}));
}

TEST_CASE("frame: motions and scales of the surface do not show" * doctest::skip(without_cgal)) {
  const auto soup = with_holes(bumpy_disk(8, 7), 48, 2, 7);
  const auto expected = frame_of(soup.mesh(), {.inner_loop = 1});
  const Eigen::Matrix3d rotation = some_rotation();
  for (const double scale : {1e-3, 1.0, 50.0}) {
    const auto moved = mapped(soup, [&](const Vector& v) { return Vector(scale * (rotation * v + Vector(3, -2, 1))); });
    const auto frame = frame_of(moved.mesh(), {.inner_loop = 1});
    for (std::size_t v = 0; v < frame.u.size(); ++v) CHECK(std::abs(frame.u[v] - expected.u[v]) < 1e-12);
    for (std::size_t t = 0; t < frame.longitudinal.size(); ++t) {
      CHECK((vector(frame.longitudinal[t]) - rotation * vector(expected.longitudinal[t])).norm() < 1e-9);
      CHECK((vector(frame.transverse[t]) - rotation * vector(expected.transverse[t])).norm() < 1e-9);
    }
  }
}

TEST_CASE("frame: triangles where u is constant borrow it, from one to the next" * doctest::skip(without_cgal)) {
  // Two folded triangles, one on the other, stand in the hole of an annulus.
  auto soup = equilateral_annulus(24);
  const std::int32_t first = 4 * 24, apex = 5 * 24, count = static_cast<std::int32_t>(soup.triangles.size());
  soup.vertices.push_back({0.3, 0.05, 0.1});
  soup.vertices.push_back({0.35, -0.05, 0.2});
  soup.triangles.push_back({first, first + 1, apex});
  soup.triangles.push_back({first, apex, apex + 1});
  const auto mesh = soup.mesh();
  REQUIRE(mesh.boundary_loops().size() == 2);
  const auto frame = frame_of(mesh, {.inner_loop = 1});
  check_frame(mesh, frame);
  CHECK(frame.borrowed_triangles == std::vector{count, count + 1});
  std::int32_t lender = -1;
  for (int k = 0; k < 3; ++k) {
    if (const auto t = mesh.neighbour(count, k).triangle; t >= 0 && t < count) lender = t;
  }
  REQUIRE(lender >= 0);
  check_same_unfolded(mesh, frame, count, lender);
  check_same_unfolded(mesh, frame, count + 1, count);
}

TEST_CASE("frame: a region that an edge of the outer loop cuts off is constant" * doctest::skip(without_cgal)) {
  const auto mesh = twin_disks(6).mesh();
  const auto half = static_cast<std::int32_t>(mesh.triangle_count()) / 2;
  const auto centre = mesh.triangles()[half - 1][2];
  const auto frame = frame_of(mesh, {.inner_point = mesh.vertices()[centre]});
  check_frame(mesh, frame);
  CHECK(frame.u[centre] == 0);
  for (std::int32_t t = half; t < 2 * half; ++t) {
    for (const auto v : mesh.triangles()[t]) CHECK(frame.u[v] == 1);
  }
}

TEST_CASE("frame: fragments have a basis too" * doctest::skip(without_cgal)) {
  const auto fragment = mapped(sphere(1), [](const Vector& v) { return Vector(0.01 * v + Vector(0, 0, 5)); });
  const auto mesh = together(with_holes(bumpy_disk(8, 4), 48, 1, 4), fragment).mesh();
  const auto frame = frame_of(mesh, {.inner_loop = 1});
  check_orthonormal(mesh, frame);
  CHECK(std::count_if(frame.u.begin(), frame.u.end(), [](double u) { return std::isnan(u); }) == 18);
  REQUIRE(frame.borrowed_triangles.size() >= 32);
  CHECK(frame.borrowed_triangles.back() == static_cast<std::int32_t>(mesh.triangle_count()) - 1);
}

TEST_CASE("frame: the centre of a hole may be critical, but is no vertex to report") {
  const auto mesh = annulus(24, 4, 1, 2).mesh();
  auto disk = halved(mesh);
  CHECK(make_reference_frame(mesh, disk).critical_points.empty());
  disk.loop_centres[1] = {0.9, 0};  // to the right of all around it
  std::int32_t sum = 0;
  for (const auto& [vertex, index] : make_reference_frame(mesh, disk).critical_points) {
    CHECK((vertex >= 0 && vertex < static_cast<std::int32_t>(mesh.vertices().size())));
    sum += index;
  }
  CHECK(sum == -1);
}

TEST_CASE("frame: where u varies by rounding alone the direction is borrowed") {
  const auto mesh = annulus(24, 4, 1, 2).mesh();
  auto disk = halved(mesh);
  const auto& [a, b, c] = mesh.triangles()[40];
  disk.points[a] = {0.3, 0.1};
  disk.points[b] = {0.3, 0.2};
  CHECK(make_reference_frame(mesh, disk).borrowed_triangles.empty());
  for (const double x : {0.3, 0.3 + 4e-16}) {
    disk.points[c] = {x, 0.3};
    CHECK(make_reference_frame(mesh, disk).borrowed_triangles == std::vector{40});
  }
}

TEST_CASE("equation 1: the paper's formula, free of signs" * doctest::skip(without_cgal)) {
  const auto [mesh, frame] = framed_dome();
  const auto field = random_field(mesh, 3);
  const auto angles = field_angles(frame, field);
  for (std::size_t t = 0; t < angles.size(); ++t) {
    const auto v = vector(field.directions()[t]);
    const double along = v.dot(vector(frame.longitudinal[t])), across = v.dot(vector(frame.transverse[t]));
    CHECK((angles[t] > -pi / 2 && angles[t] <= pi / 2));
    CHECK(std::abs(angles[t] - (along < 0 ? -1 : 1) * std::asin(std::clamp(across, -1.0, 1.0))) < 1e-7);
  }
  ReferenceFrame reversed = frame;  // the field's sign is free, so it is the frame that is turned
  for (auto* basis : {&reversed.longitudinal, &reversed.transverse}) {
    for (auto& e : *basis) e = {-e[0], -e[1], -e[2]};
  }
  CHECK(field_angles(reversed, field) == angles);
}

TEST_CASE("equation 1: e_l is at 0, e_t at +pi/2" * doctest::skip(without_cgal)) {
  const auto [mesh, frame] = framed_dome();
  for (const double angle : {0.0, pi}) {
    const std::vector<double> constant(mesh.triangle_count(), angle);
    for (const double a : field_angles(frame, field_from_angles(mesh, frame, constant))) CHECK(std::abs(a) < 1e-14);
  }
  for (const double angle : {pi / 2, -pi / 2}) {
    const std::vector<double> constant(mesh.triangle_count(), angle);
    for (const double a : field_angles(frame, field_from_angles(mesh, frame, constant))) {
      CHECK((a > -pi / 2 && a <= pi / 2));
      CHECK(std::abs(std::abs(a) - pi / 2) < 1e-14);
    }
  }
}

TEST_CASE("equations 1 and 2 undo each other" * doctest::skip(without_cgal)) {
  const auto [mesh, frame] = framed_dome();
  Random random(9);
  std::vector<double> angles;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) angles.push_back(40 * random.unit() - 20);
  const auto back = field_angles(frame, field_from_angles(mesh, frame, angles));
  for (std::size_t t = 0; t < angles.size(); ++t) CHECK(std::abs(std::sin(back[t] - angles[t])) < 1e-13);

  const auto field = smooth_field(mesh);
  const auto again = field_from_angles(mesh, frame, field_angles(frame, field));
  for (std::size_t t = 0; t < angles.size(); ++t) {
    CHECK(line_angle(vector(field.directions()[t]), vector(again.directions()[t])) < 1e-13);
  }
}

TEST_CASE("equations 1 and 2: triangles without a direction" * doctest::skip(without_cgal)) {
  const auto [mesh, frame] = framed_dome();
  std::vector<double> angles(mesh.triangle_count(), 0.3);
  angles[4] = nan;
  angles[5] = std::numeric_limits<double>::infinity();
  const auto field = field_from_angles(mesh, frame, angles);
  CHECK(field.count(DirectionStatus::valid) == mesh.triangle_count() - 2);
  const auto back = field_angles(frame, field);
  for (std::size_t t = 0; t < back.size(); ++t) CHECK(std::isnan(back[t]) == (t == 4 || t == 5));
  CHECK_THROWS_AS(field_from_angles(mesh, frame, std::vector(mesh.triangle_count(), nan)), InvalidField);
  CHECK_THROWS_AS(field_from_angles(mesh, frame, {}), InvalidField);
  const auto other = grid(2, 2).mesh();
  CHECK_THROWS_AS(field_from_angles(other, frame, angles), InvalidField);
  CHECK_THROWS_AS(field_angles(frame, constant_field(other, Vector::UnitX())), InvalidField);
}

TEST_CASE("frame: options that contradict each other or the surface are refused" * doctest::skip(without_cgal)) {
  const auto fin = mapped(one_triangle(), [](const Vector& v) { return Vector(0.01 * v + Vector(0, 0, 5)); });
  const auto mesh = together(with_holes(bumpy_disk(8, 4), 48, 1, 4), fin).mesh();
  const auto map = parameterize(mesh);
  const Vec3 point = mesh.vertices()[100];
  const auto check_refused = [&](const ReferenceFrameOptions& options) {
    CHECK_THROWS_AS(make_reference_frame(mesh, map, options), InvalidOption);
  };
  check_refused({.inner_loop = 0});  // the outer one
  check_refused({.inner_loop = 2});  // of the fragment
  check_refused({.inner_loop = 3});
  check_refused({.inner_loop = -1});
  check_refused({.inner_loop = 1, .inner_point = point});
  check_refused({.inner_point = Vec3{nan, 0, 0}});
  check_refused({.inner_point = Vec3{0, std::numeric_limits<double>::infinity(), 0}});
  check_refused({.inner_point = Vec3{2, 0, 0}});  // nearest to the border
  CHECK(make_reference_frame(mesh, map, {.inner_point = Vec3{0, 0, 1e3}}).critical_points.empty());
}

TEST_CASE("frame: a parameterization of another mesh is refused" * doctest::skip(without_cgal)) {
  const auto mesh = cylinder(12, 4, 1, 2).mesh(), other = cylinder(12, 5, 1, 2).mesh();
  auto map = parameterize(mesh);
  CHECK_THROWS_AS(make_reference_frame(other, map), InvalidOption);
  map.outer_loop = 2;
  CHECK_THROWS_AS(make_reference_frame(mesh, map), InvalidOption);
  map.outer_loop = 0;
  map.points[7][0] = nan;
  CHECK_THROWS_AS(make_reference_frame(mesh, map), InvalidOption);
}

}  // namespace pectinate::test
