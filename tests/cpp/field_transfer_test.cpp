// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "detail/disk_locator.hpp"
#include "disks.hpp"
#include "fields.hpp"
#include "pectinate/comparison.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;
using detail::vector;
using Eigen::Vector2d;
using Map = Eigen::Matrix<double, 3, 2>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
const bool without_cgal = !has_parameterization();

double worst_angle(const OrientationField& a, const OrientationField& b) {
  double worst = 0;
  for (const double angle : angles_between(a, b)) worst = std::max(worst, std::isnan(angle) ? infinity : angle);
  return worst;
}

std::vector<std::int32_t> each_its_own(const SurfaceMesh& mesh) {
  std::vector<std::int32_t> triangles(mesh.triangle_count());
  std::iota(triangles.begin(), triangles.end(), 0);
  return triangles;
}

Vector eastwards(const Vector& place) {
  return Vector::UnitZ().cross(place);
}

/// A flat unit disk with holes as its own map, turned by an angle.
Parameterization flat_map(const SurfaceMesh& mesh, double angle = 0) {
  const Eigen::Rotation2Dd turn(angle);
  const auto turned = [&](const Vec3& v) {
    const Vector2d p = turn * Vector2d(v[0], v[1]);
    return DiskPoint{p.x(), p.y()};
  };
  Parameterization map{{}, 0, 0, {}, {}, {}};
  for (const auto& v : mesh.vertices()) map.points.push_back(turned(v));
  for (const auto& loop : mesh.boundary_loops()) map.loop_centres.push_back(turned(loop.centroid));
  return map;
}

Soup holed_disk(std::uint64_t seed) {
  return with_holes(jittered_disk(8, seed), 48, 3, seed);
}

/// All loops, each with the one of the same index.
std::vector<std::array<std::int32_t, 2>> same_loops(const SurfaceMesh& mesh) {
  std::vector<std::array<std::int32_t, 2>> pairs;
  for (std::int32_t l = 0; l < static_cast<std::int32_t>(mesh.boundary_loops().size()); ++l) pairs.push_back({l, l});
  return pairs;
}

Soup mapped_disk(const Soup& soup, const Map& map) {
  return mapped(soup, [&](const Vector& v) { return Vector(map * v.head<2>()); });
}

/// A bent disk without the triangles in a round bay, which is its loop 1.
Soup dome(const Soup& disk) {
  Soup soup = disk;
  std::erase_if(soup.triangles, [&](const Triangle& t) {
    Vector c = Vector::Zero();
    for (const auto v : t) c += vector(disk.vertices[v]) / 3;
    return (c - Vector(0.4, 0.1, 0)).norm() < 0.25;
  });
  return mapped(soup, [](const Vector& v) { return Vector(v.x(), v.y(), std::cos(v.x()) * std::cos(2 * v.y())); });
}

/// The median angle to a smooth field that was carried from one mesh of a dome to another.
template <class MakeMap>
double median_error(int rings, const MakeMap& make_map) {
  const auto whirl = [](const Vector& c, const Vector&) { return Vector(std::cos(3 * c.x()), 1 + c.x() * c.y(), 0.3); };
  const auto source = dome(hexagonal_disk(rings)).mesh(), target = dome(jittered_disk(rings + 1, 5)).mesh();
  const auto result =
      transfer_through_disks(source, make_map(source), field_of(source, whirl), target, make_map(target), {{1, 1}});
  auto angles = angles_between(result.field, field_of(target, whirl));
  std::erase_if(angles, [](double angle) { return std::isnan(angle); });
  CHECK(static_cast<double>(angles.size()) > 0.9 * static_cast<double>(target.triangle_count()));
  std::nth_element(angles.begin(), angles.begin() + angles.size() / 2, angles.end());
  return angles[angles.size() / 2];
}

const Map some_map{{2, 0.5}, {-0.3, 0.7}, {0.9, -1.1}};

}  // namespace

TEST_CASE("transfer by nearest point: a surface gives itself its field") {
  for (const auto& mesh : {sphere(2).mesh(), torus(14, 9).mesh(), moebius_strip(20, 3).mesh(), grid(4, 3).mesh()}) {
    const auto field = random_field(mesh, 3);
    const auto result = transfer_by_nearest_point(mesh, field, mesh, infinity);
    CHECK(worst_angle(result.field, field) < 1e-9);
    CHECK(result.source_triangles == each_its_own(mesh));
    for (const double distance : result.distances) CHECK(distance < 1e-14);
  }
}

TEST_CASE("transfer by nearest point: onto another mesh of a sphere the field is found better and better") {
  double previous = infinity;
  for (const int subdivisions : {2, 3, 4}) {
    const auto source = sphere(subdivisions).mesh();
    const auto target =
        mapped(sphere(subdivisions), [](const Vector& v) { return Vector(some_rotation() * v); }).mesh();
    const auto result = transfer_by_nearest_point(
        source, field_of(source, [](const Vector& c, const Vector&) { return eastwards(c); }), target, 1);
    double worst = 0;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(target.triangle_count()); ++t) {
      const Vector expected = eastwards(centre(target, t));
      if (expected.norm() > 0.5) worst = std::max(worst, line_angle(vector(result.field.directions()[t]), expected));
    }
    CHECK(worst < 0.65 * previous);
    previous = worst;
  }
  CHECK(previous < 0.1);
}

TEST_CASE("transfer by nearest point: directions turn with their plane, whichever way it is wound") {
  const auto source = grid(4, 4).mesh();
  for (const double slope : {0.0, 0.4, 1.2, -1.5}) {
    const Eigen::AngleAxisd turn(slope, Vector::UnitX());  // about a line in the source
    for (const bool backwards : {false, true}) {
      Soup soup = mapped(one_triangle(), [&](const Vector& v) { return Vector(turn * v + Vector(1.2, 1.3, 0)); });
      if (backwards) std::swap(soup.triangles[0][1], soup.triangles[0][2]);
      for (const double angle : {0.0, 0.7, 1.9}) {
        const Vector direction(std::cos(angle), std::sin(angle), 0);
        const auto result = transfer_by_nearest_point(source, constant_field(source, direction), soup.mesh(), infinity);
        CHECK(line_angle(vector(result.field.directions()[0]), turn * direction) < 1e-14);
      }
    }
  }
}

TEST_CASE("transfer by nearest point: what is too far, or near to a triangle without direction, gets none") {
  const auto source = grid(4, 4).mesh();
  const auto target = mapped(grid(4, 4), [](const Vector& v) { return Vector(v.x(), v.y(), 0.1 * v.x()); }).mesh();
  const auto field = field_of(source, [](const Vector& c, const Vector&) { return Vector(c.y() > 2 ? 1 : 0, 0, 0); });
  const auto result = transfer_by_nearest_point(source, field, target, 0.2);
  std::size_t far_count = 0;
  for (std::int32_t t = 0; t < 32; ++t) {
    const Vector c = centre(target, t);
    const bool far = c.z() > 0.2;
    far_count += far ? 1 : 0;
    CHECK(result.source_triangles[t] == (far ? -1 : t));
    CHECK(std::isnan(result.distances[t]) == far);
    if (!far) CHECK(result.distances[t] == doctest::Approx(c.z()).epsilon(1e-14));
    CHECK(result.field.has_direction(t) == (!far && c.y() > 2));
  }
  CHECK(far_count > 10);
  const auto above = moved(grid(4, 4), {0, 0, 0.25}).mesh();  // the limit itself is near enough
  CHECK(transfer_by_nearest_point(source, field, above, 0.25).field.count(DirectionStatus::valid) == 16);
}

TEST_CASE("transfer by nearest point: bad input is refused") {
  const auto mesh = grid(2, 2).mesh(), other = grid(3, 2).mesh();
  const auto field = constant_field(mesh, Vector::UnitX());
  for (const double bad : {0.0, -1.0, nan, -infinity}) {
    CHECK_THROWS_AS(transfer_by_nearest_point(mesh, field, other, bad), InvalidOption);
  }
  CHECK_THROWS_AS(transfer_by_nearest_point(other, field, mesh, 1), InvalidField);
  CHECK_THROWS_AS(transfer_by_nearest_point(mesh, field, moved(grid(2, 2), {0, 0, 5}).mesh(), 1), InvalidField);
  CHECK_THROWS_AS(transfer_by_nearest_point(mesh, field, moved(grid(2, 2), {0, 0, 1e12}).mesh(), 1), InvalidOption);
}

TEST_CASE("disk locator: agrees with a search of all triangles") {
  const auto mesh = with_holes(jittered_disk(6, 4), 36, 3, 4).mesh();
  const auto points = flat_map(mesh).points;
  const detail::DiskLocator locator(mesh, points);
  Random random(5);
  std::size_t found = 0;
  for (int i = 0; i < 2000; ++i) {
    const double x = 2 * random.unit() - 1, y = 2 * random.unit() - 1;
    std::int32_t expected = -1;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
      bool is_inside = true;
      for (int k = 0; k < 3; ++k) {
        const Vector a = corner(mesh, t, k), b = corner(mesh, t, k + 1);
        is_inside = is_inside && (b - a).cross(Vector(x, y, 0) - a).z() > 0;
      }
      if (is_inside) expected = t;
    }
    const auto place = locator.find({x, y});
    CHECK((place ? place->triangle : -1) == expected);
    if (!place) continue;
    ++found;
    Vector sum = Vector::Zero();
    for (int k = 0; k < 3; ++k) {
      CHECK(place->weights[k] >= 0);
      sum += place->weights[k] * corner(mesh, place->triangle, k);
    }
    CHECK((sum - Vector(x, y, 0)).norm() < 1e-14);
  }
  CHECK(found > 1000);
}

TEST_CASE("disk locator: triangles of every size down to 1e-19 are found, and so are all sides and corners") {
  // Rings that shrink towards a place off the middle, where coordinates are coarsest.
  Soup soup = annulus(24, 90, 1, 91);
  soup = mapped(soup, [](const Vector& v) {
    const double radius = 0.5 * std::exp(-0.225 * (91 - v.norm()));
    return Vector(radius * v.normalized() + Vector(0.3, -0.2, 0));
  });
  // As it is, not as a surface: so small triangles would be joined in another way.
  const auto shape = annulus(24, 90, 1, 91).mesh();
  std::vector<DiskPoint> points;
  for (const auto& [x, y, z] : soup.vertices) points.push_back({x, y});
  const detail::DiskLocator locator(shape, points);
  double least_area = infinity;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(shape.triangle_count()); ++t) {
    const auto image = detail::disk_triangle(shape, points, t);
    REQUIRE(image);
    const auto& [a, b, c] = image->corners;
    least_area = std::min(least_area, detail::cross(b - a, c - a) / 2);
    const auto place = locator.find((a + b + c) / 3);
    REQUIRE(place);
    CHECK(place->triangle == t);
    for (const double weight : place->weights) CHECK(std::abs(weight - 1.0 / 3) < 1e-5);
    for (const Vector2d& point : {a, Vector2d((a + b) / 2), Vector2d(0.9 * b + 0.1 * c)}) CHECK(locator.find(point));
  }
  CHECK(least_area < 1e-19);
  CHECK(!locator.find({0.3, -0.2}));
  CHECK(!locator.find({0.9, 0.9}));
}

TEST_CASE("disk locator: triangles without a place are never found") {
  const auto mesh = grid(1, 1).mesh();
  std::vector<DiskPoint> points{{0, 0}, {0.5, 0}, {0, 0.5}, {nan, nan}};
  CHECK(!detail::DiskLocator(mesh, points).find({0.1, 0.1}));
  points[3] = {0.5, 0.5};
  CHECK(detail::DiskLocator(mesh, points).find({0.4, 0.1})->triangle == 0);
  points[3] = {1, 0};  // the first is flat now
  CHECK(detail::DiskLocator(mesh, points).find({0.25, 0.1})->triangle == 1);
  CHECK(!detail::DiskLocator(mesh, points).find({0.25, -0.1}));
}

TEST_CASE("transfer through disks: a surface gives itself its field" * doctest::skip(without_cgal)) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto mesh = with_holes(bumpy_disk(10, seed), 60, 4, seed).mesh();
    const auto map = parameterize(mesh);
    const auto field = random_field(mesh, seed);
    const auto result = transfer_through_disks(mesh, map, field, mesh, map, {{1, 1}});
    CHECK(worst_angle(result.field, field) < 1e-9);
    CHECK(result.source_triangles == each_its_own(mesh));
    for (const double distance : result.distances) CHECK(distance < 1e-9);
  }
}

TEST_CASE("transfer through disks: between other meshes of one disk a constant field stays, but in holes") {
  const auto source = holed_disk(1).mesh(), target = with_holes(jittered_disk(11, 7), 66, 2, 8).mesh();
  const Vector direction(0.8, -0.6, 0);
  const auto field = constant_field(source, direction);
  for (const double angle : {0.0, 2.1}) {
    auto source_map = flat_map(source), target_map = flat_map(target, angle);
    target_map.loop_centres[2] = flat_map(source, angle).loop_centres[1];
    const auto result = transfer_through_disks(source, source_map, field, target, target_map, {{1, 2}});
    std::size_t in_holes = 0;
    const detail::DiskLocator locator(source, source_map.points);
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(target.triangle_count()); ++t) {
      const auto place = locator.find(centre(target, t).head<2>());
      CHECK(result.source_triangles[t] == (place ? place->triangle : -1));
      CHECK(result.field.has_direction(t) == place.has_value());
      if (place) {
        CHECK(result.distances[t] < 1e-14);
        CHECK(line_angle(vector(result.field.directions()[t]), direction) < 1e-12);
      } else {
        CHECK(std::isnan(result.distances[t]));
        ++in_holes;
      }
    }
    CHECK(in_holes > 3);
    CHECK(in_holes < target.triangle_count() / 5);
  }
}

TEST_CASE("transfer through disks: directions are carried by the differential") {
  const auto soup = holed_disk(2);
  const auto flat = soup.mesh(), bent = mapped_disk(soup, some_map).mesh();
  const auto map = flat_map(flat);
  const Vector direction(0.28, 0.96, 0);
  const auto field = constant_field(flat, direction);
  const Vector expected = some_map * direction.head<2>();
  const auto there = transfer_through_disks(flat, map, field, bent, map, same_loops(flat));
  CHECK(worst_angle(there.field, constant_field(bent, expected)) < 1e-12);
  const auto back = transfer_through_disks(bent, map, there.field, flat, map, same_loops(flat));
  CHECK(worst_angle(back.field, field) < 1e-12);

  // A field that varies, on a surface that is no plane: the differential is that of each triangle.
  const auto paraboloid =
      mapped(soup, [](const Vector& v) { return Vector(v.x(), v.y(), 1 - v.squaredNorm()); }).mesh();
  const auto varying = random_field(flat, 4);
  const auto lifted = transfer_through_disks(flat, map, varying, paraboloid, map, {{1, 1}});
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(flat.triangle_count()); ++t) {
    const auto lift = vector(lifted.field.directions()[t]);
    CHECK(line_angle({lift.x(), lift.y(), 0}, vector(varying.directions()[t])) < 1e-11);
  }
}

TEST_CASE("transfer through disks: a moved and scaled copy has the moved field" * doctest::skip(without_cgal)) {
  const auto soup = with_holes(bumpy_disk(10, 3), 60, 4, 3);
  const auto source = soup.mesh();
  const auto field = random_field(source, 8);
  // Its vertices come in another order, so that its outer loop starts elsewhere and its disk is turned.
  const auto count = static_cast<std::int32_t>(soup.vertices.size());
  const auto place = [&](std::int32_t v) { return (v + count - 25) % count; };
  Soup copy = soup;
  for (std::int32_t v = 0; v < count; ++v) {
    const Vector moved = 3.7 * (some_rotation() * vector(soup.vertices[v])) + Vector(5, -4, 2);
    copy.vertices[place(v)] = detail::vec3(moved);
  }
  for (auto& triangle : copy.triangles) {
    for (auto& v : triangle) v = place(v);
  }
  const auto target = copy.mesh();
  const auto result =
      transfer_through_disks(source, parameterize(source), field, target, parameterize(target), same_loops(source));
  CHECK(result.source_triangles == each_its_own(source));
  for (std::size_t t = 0; t < source.triangle_count(); ++t) {
    const Vector expected = some_rotation() * vector(field.directions()[t]);
    CHECK(line_angle(vector(result.field.directions()[t]), expected) < 1e-6);
  }
}

TEST_CASE("transfer through disks: onto another mesh of a dome the field is found better and better") {
  // Two maps that are one and the same function; the bay's centres differ a little, and are put in one place.
  double previous = infinity;
  for (const int rings : {6, 12, 24}) {
    const double error = median_error(rings, [](const SurfaceMesh& mesh) {
      auto map = flat_map(mesh);
      map.loop_centres[1] = {0.4, 0.1};
      return map;
    });
    CHECK(error < 0.65 * previous);
    previous = error;
  }
  CHECK(previous < 0.03);
}

TEST_CASE("transfer through disks: mean value maps of two meshes of a dome are much alike" *
          doctest::skip(without_cgal)) {
  for (const int rings : {12, 24}) {
    const double error = median_error(rings, [](const SurfaceMesh& mesh) { return parameterize(mesh); });
    CHECK(error < 0.1);
  }
}

TEST_CASE("transfer through disks: loops that do not fit are refused") {
  const auto mesh = holed_disk(1).mesh();
  const auto map = flat_map(mesh);
  const auto field = constant_field(mesh, Vector::UnitX());
  REQUIRE(mesh.boundary_loops().size() == 4);
  using Pairs = std::vector<std::array<std::int32_t, 2>>;
  for (const Pairs& bad : {Pairs{}, Pairs{{0, 0}}, Pairs{{4, 1}}, Pairs{{1, 4}}, Pairs{{-1, 1}}, Pairs{{1, 1}, {1, 2}},
                           Pairs{{1, 1}, {2, 1}}, Pairs{{1, 0}, {2, 2}}, Pairs{{0, 1}, {2, 2}}}) {
    CHECK_THROWS_AS(transfer_through_disks(mesh, map, field, mesh, map, bad), InvalidOption);
  }
  auto centred = map, fragment = map;
  centred.loop_centres[1] = {1e-12, 0};
  fragment.loop_centres[1] = {nan, nan};
  for (const auto& other : {centred, fragment}) {
    CHECK_THROWS_AS(transfer_through_disks(mesh, map, field, mesh, other, {{1, 1}}), InvalidOption);
    CHECK_THROWS_AS(transfer_through_disks(mesh, other, field, mesh, map, {{1, 1}}), InvalidOption);
    CHECK(worst_angle(transfer_through_disks(mesh, map, field, mesh, map, {{2, 2}}).field, field) < 1e-12);
  }
}

TEST_CASE("transfer through disks: maps and fields of other meshes are refused") {
  const auto mesh = holed_disk(1).mesh(), other = with_holes(jittered_disk(6, 1), 36, 3, 1).mesh();
  const auto map = flat_map(mesh), other_map = flat_map(other);
  const auto field = constant_field(mesh, Vector::UnitX());
  CHECK_THROWS_AS(transfer_through_disks(mesh, other_map, field, mesh, map, {{1, 1}}), InvalidOption);
  CHECK_THROWS_AS(transfer_through_disks(mesh, map, field, mesh, other_map, {{1, 1}}), InvalidOption);
  CHECK_THROWS_AS(transfer_through_disks(other, other_map, field, mesh, map, {{1, 1}}), InvalidField);
  for (const DiskPoint& bad : {DiskPoint{infinity, 0}, DiskPoint{0, 2}, DiskPoint{nan, 0}, DiskPoint{1e300, -1e300}}) {
    auto outside = map;
    outside.points[60] = bad;
    CHECK_THROWS_AS(transfer_through_disks(mesh, outside, field, mesh, map, {{1, 1}}), InvalidOption);
  }
  auto without_loop = map, nowhere = map;
  without_loop.outer_loop = 4;
  CHECK_THROWS_AS(transfer_through_disks(mesh, without_loop, field, mesh, map, {{1, 1}}), InvalidOption);
  for (auto& point : nowhere.points) point = {nan, nan};
  CHECK_THROWS_AS(transfer_through_disks(mesh, nowhere, field, mesh, map, {{1, 1}}), InvalidField);
}

}  // namespace pectinate::test
