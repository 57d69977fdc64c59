// SPDX-License-Identifier: MIT
#include "pectinate/parameterization.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <limits>
#include <numeric>

#include "disks.hpp"
#include "fields.hpp"
#include "pectinate/demo_atrium.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;
using detail::vector;

const bool without_cgal = !has_parameterization();

double greatest_distance(const std::vector<DiskPoint>& a, const std::vector<DiskPoint>& b) {
  REQUIRE(a.size() == b.size());
  double greatest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    greatest = std::max(greatest, std::hypot(a[i][0] - b[i][0], a[i][1] - b[i][1]));
  }
  return greatest;
}

std::vector<DiskPoint> flat_points(const SurfaceMesh& mesh) {
  std::vector<DiskPoint> points;
  for (const auto& [x, y, z] : mesh.vertices()) points.push_back({x, y});
  return points;
}

double disk_area(const SurfaceMesh& mesh, const Parameterization& map, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles()[t];
  const auto& p = map.points;
  return ((p[b][0] - p[a][0]) * (p[c][1] - p[a][1]) - (p[b][1] - p[a][1]) * (p[c][0] - p[a][0])) / 2;
}

/// What is true of every map.
void check_map(const SurfaceMesh& mesh, const Parameterization& map) {
  CHECK(map.flipped_triangles.empty());
  REQUIRE(map.distortion.size() == mesh.triangle_count());
  double shares = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    CHECK(disk_area(mesh, map, t) > 0);
    CHECK(map.distortion[t].area_ratio > 0);
    CHECK(map.distortion[t].anisotropy >= 1);
    shares += map.distortion[t].area_ratio * mesh.triangle_areas()[t] / mesh.area();
  }
  CHECK(shares == doctest::Approx(1).epsilon(1e-12));
  for (const auto& [x, y] : map.points) CHECK(x * x + y * y < 1 + 1e-15);

  const auto& loop = mesh.boundary_loops()[map.outer_loop];
  double length = 0;
  for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
    const double angle = 2 * std::numbers::pi * length / loop.length;
    const auto& [x, y] = map.points[loop.vertices[i]];
    CHECK(std::abs(x - std::cos(angle)) < 1e-13);
    CHECK(std::abs(y - std::sin(angle)) < 1e-13);
    const auto next = loop.vertices[(i + 1) % loop.vertices.size()];
    length += (vector(mesh.vertices()[next]) - vector(mesh.vertices()[loop.vertices[i]])).norm();
  }
}

SurfaceMesh demo_mesh(double edge_length) {
  const auto atrium = make_demo_atrium({edge_length});
  return SurfaceMesh(atrium.vertices, atrium.triangles);
}

}  // namespace

TEST_CASE("parameterization: a flat disk with an evenly spaced border maps to itself" * doctest::skip(without_cgal)) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto mesh = jittered_disk(8, seed).mesh();
    const auto map = parameterize(mesh);
    check_map(mesh, map);
    CHECK(greatest_distance(map.points, flat_points(mesh)) < 1e-12);
    for (const auto& [area_ratio, anisotropy] : map.distortion) {
      CHECK(area_ratio == doctest::Approx(1).epsilon(1e-10));
      CHECK(anisotropy == doctest::Approx(1).epsilon(1e-10));
    }
    CHECK(map.outer_loop == 0);
    CHECK(map.loop_ambiguity == 0);
    CHECK(map.loop_centres == std::vector<DiskPoint>{{0, 0}});
  }
}

TEST_CASE("parameterization: filled holes leave a flat disk as it is" * doctest::skip(without_cgal)) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto mesh = with_holes(jittered_disk(8, seed), 48, 4, seed).mesh();
    REQUIRE(mesh.boundary_loops().size() == 5);
    const auto map = parameterize(mesh);
    check_map(mesh, map);
    CHECK(greatest_distance(map.points, flat_points(mesh)) < 1e-12);
    CHECK(map.loop_ambiguity == mesh.boundary_loops()[1].length / mesh.boundary_loops()[0].length);
    for (std::size_t l = 1; l < 5; ++l) {
      const auto& centroid = mesh.boundary_loops()[l].centroid;
      CHECK(greatest_distance({map.loop_centres[l]}, {{centroid[0], centroid[1]}}) < 1e-12);
    }
  }
  const auto annulus = equilateral_annulus(24).mesh();
  CHECK(greatest_distance(parameterize(annulus).points, flat_points(annulus)) < 1e-12);
}

TEST_CASE("parameterization: inner vertices are averages under Floater's weights" * doctest::skip(without_cgal)) {
  const auto mesh = bumpy_disk(12, 5).mesh();
  const auto map = parameterize(mesh);
  std::vector<Eigen::Vector3d> sums(mesh.vertices().size(), Eigen::Vector3d::Zero());  // weighted points, weights
  const auto angle = [](const Vector& u, const Vector& v) { return std::atan2(u.cross(v).norm(), u.dot(v)); };
  for (const auto& corners : mesh.triangles()) {
    for (int k = 0; k < 3; ++k) {
      const auto i = corners[k];
      for (const auto& [j, other] : {std::pair(corners[(k + 1) % 3], corners[(k + 2) % 3]),
                                     std::pair(corners[(k + 2) % 3], corners[(k + 1) % 3])}) {
        const Vector spoke = vector(mesh.vertices()[j]) - vector(mesh.vertices()[i]);
        const Vector side = vector(mesh.vertices()[other]) - vector(mesh.vertices()[i]);
        const double weight = std::tan(angle(spoke, side) / 2) / spoke.norm();
        sums[i] += weight * Eigen::Vector3d(map.points[j][0], map.points[j][1], 1);
      }
    }
  }
  for (std::size_t v = 72; v < sums.size(); ++v) {
    CHECK(std::abs(sums[v].x() / sums[v].z() - map.points[v][0]) < 1e-13);
    CHECK(std::abs(sums[v].y() / sums[v].z() - map.points[v][1]) < 1e-13);
  }
}

TEST_CASE("parameterization: no triangle flips on bumpy disks with holes" * doctest::skip(without_cgal)) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    const auto mesh = with_holes(bumpy_disk(14, seed), 84, 5, seed).mesh();
    check_map(mesh, parameterize(mesh));
  }
}

TEST_CASE("parameterization: any loop of the demo atrium can be the circle" * doctest::skip(without_cgal)) {
  const auto mesh = demo_mesh(2);
  REQUIRE(mesh.boundary_loops().size() == 5);
  for (std::int32_t loop = 0; loop < 5; ++loop) {
    const auto map = parameterize(mesh, {loop});
    CHECK(map.outer_loop == loop);
    CHECK(map.loop_centres[loop] == DiskPoint{0, 0});
    check_map(mesh, map);
  }
  CHECK(parameterize(mesh).points == parameterize(mesh, {0}).points);
}

TEST_CASE("parameterization: motions and scales of the surface do not show" * doctest::skip(without_cgal)) {
  const auto soup = with_holes(bumpy_disk(10, 3), 60, 3, 3);
  const auto expected = parameterize(soup.mesh()).points;
  const Eigen::Matrix3d rotation = some_rotation();
  const auto turned = mapped(soup, [&](const Vector& v) { return Vector(rotation * v + Vector(3, -2, 1)); });
  CHECK(greatest_distance(parameterize(turned.mesh()).points, expected) < 1e-12);
  for (const double scale : {1e-3, 7.0, 1e6}) {
    const auto scaled = mapped(soup, [&](const Vector& v) { return Vector(scale * v); });
    CHECK(greatest_distance(parameterize(scaled.mesh()).points, expected) < 1e-12);
  }
}

TEST_CASE("parameterization: the disk is seen from outside" * doctest::skip(without_cgal)) {
  // Outside is told by the dome's volume, so the input's windings do not matter; a flat disk follows them.
  auto dome = bumpy_disk(8, 2), flat = jittered_disk(8, 2);
  const auto dome_points = parameterize(dome.mesh()).points, flat_points = parameterize(flat.mesh()).points;
  for (auto* soup : {&dome, &flat}) {
    for (auto& [a, b, c] : soup->triangles) std::swap(b, c);
  }
  CHECK(greatest_distance(parameterize(dome.mesh()).points, dome_points) < 1e-12);
  auto mirrored = parameterize(flat.mesh()).points;
  for (auto& point : mirrored) point[1] = -point[1];
  CHECK(greatest_distance(mirrored, flat_points) < 1e-12);
}

TEST_CASE("parameterization: slits and holes whose centre is one of their vertices" * doctest::skip(without_cgal)) {
  // Cut open from (2, 4) over (3, 4) to (4, 4): the curve's centroid is where the middle vertex lies, twice.
  Soup soup = grid(8, 8);
  const auto at = [](int i, int j) { return i + 9 * j; };
  const auto copy = static_cast<std::int32_t>(soup.vertices.size());
  soup.vertices.push_back(soup.vertices[at(3, 4)]);
  for (auto& corners : soup.triangles) {
    const bool above = std::any_of(corners.begin(), corners.end(), [&](auto v) { return v >= at(0, 5) && v != copy; });
    if (above) std::replace(corners.begin(), corners.end(), at(3, 4), copy);
  }
  const auto mesh = soup.mesh();
  REQUIRE(mesh.boundary_loops().size() == 2);
  REQUIRE(mesh.boundary_loops()[1].vertices.size() == 4);
  check_map(mesh, parameterize(mesh));
}

TEST_CASE("parameterization: a single triangle" * doctest::skip(without_cgal)) {
  const auto mesh = one_triangle().mesh();
  check_map(mesh, parameterize(mesh));
}

TEST_CASE("parameterization: regions that one edge joins to the rest" * doctest::skip(without_cgal)) {
  const auto mesh = twin_disks(6).mesh();
  REQUIRE(mesh.boundary_loops().size() == 1);
  check_map(mesh, parameterize(mesh));
}

TEST_CASE("parameterization: fragments have no place in the disk and change nothing" * doctest::skip(without_cgal)) {
  const auto alone = parameterize(with_holes(bumpy_disk(8, 4), 48, 2, 4).mesh());
  const auto fin = mapped(one_triangle(), [](const Vector& v) { return Vector(0.01 * v + Vector(0, 0, 5)); });
  const auto mesh = together(fin, with_holes(bumpy_disk(8, 4), 48, 2, 4)).mesh();
  REQUIRE(mesh.components().size() == 2);
  const auto map = parameterize(mesh);
  for (int v = 0; v < 3; ++v) CHECK(std::isnan(map.points[v][0]));
  CHECK(std::vector(map.points.begin() + 3, map.points.end()) == alone.points);
  CHECK(std::isnan(map.distortion[0].area_ratio));
  CHECK(std::isnan(map.distortion[0].anisotropy));
  CHECK(map.flipped_triangles.empty());
  CHECK(map.loop_ambiguity == alone.loop_ambiguity);
  REQUIRE(mesh.boundary_loops().size() == 4);
  CHECK(mesh.boundary_loops()[3].component == 0);
  CHECK(std::isnan(map.loop_centres[3][0]));
  CHECK_THROWS_AS(parameterize(mesh, {3}), InvalidOption);
}

TEST_CASE("parameterization: surfaces that have no map onto a disk are refused") {
  CHECK_THROWS_AS(parameterize(sphere(1).mesh()), InvalidMesh);
  CHECK_THROWS_AS(parameterize(torus(12, 6).mesh()), InvalidMesh);
  CHECK_THROWS_AS(parameterize(moebius_strip(20, 3).mesh()), InvalidMesh);
  CHECK_THROWS_AS(parameterize(klein_bottle(16, 8).mesh()), InvalidMesh);
  CHECK_THROWS_AS(parameterize(bow_tie().mesh()), InvalidMesh);
  CHECK_THROWS_AS(parameterize(together(grid(2, 2), moved(grid(2, 2), {9, 0, 0})).mesh()), InvalidMesh);
  auto holed_torus = torus(12, 6);
  holed_torus.triangles.pop_back();
  CHECK_THROWS_AS(parameterize(holed_torus.mesh()), InvalidMesh);
}

TEST_CASE("parameterization: loops that do not exist are refused") {
  const auto mesh = cylinder(8, 3, 1, 2).mesh();
  for (const std::int32_t loop : {-1, 2, std::numeric_limits<std::int32_t>::max()}) {
    CHECK_THROWS_AS(parameterize(mesh, {loop}), InvalidOption);
  }
}

TEST_CASE("parameterization: a build without CGAL says how to get it" * doctest::skip(!without_cgal)) {
  CHECK_THROWS_WITH_AS(parameterize(grid(2, 2).mesh()), doctest::Contains("PECTINATE_WITH_CGAL"), Error);
}

}  // namespace pectinate::test
