// SPDX-License-Identifier: MIT
#include "pectinate/tubes.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "fields.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;
using detail::vector;
using std::numbers::pi;

/// Lines drawn by hand on one flat triangle; `make_tubes` reads no more of a placement than this.
Placement drawn(const std::vector<std::vector<Vec3>>& lines) {
  Placement placement;
  placement.offsets.push_back(0);
  for (const auto& line : lines) {
    placement.points.insert(placement.points.end(), line.begin(), line.end());
    placement.segment_triangles.insert(placement.segment_triangles.end(), line.size() - 1, 0);
    placement.offsets.push_back(static_cast<std::int64_t>(placement.points.size()));
  }
  return placement;
}

/// A line along x with a point every `step`.
std::vector<Vec3> straight(int segments, double step) {
  std::vector<Vec3> line;
  for (int i = 0; i <= segments; ++i) line.push_back({i * step, 0, 0});
  return line;
}

std::vector<Triangle> triangles_of(const Tubes& tubes, std::size_t i) {
  return {tubes.triangles.begin() + tubes.triangle_offsets[i], tubes.triangles.begin() + tubes.triangle_offsets[i + 1]};
}

double area(const Tubes& tubes, const Triangle& t) {
  const auto at = [&](int k) { return vector(tubes.vertices[t[k]]); };
  return (at(1) - at(0)).cross(at(2) - at(0)).norm() / 2;
}

double volume(const Tubes& tubes, std::size_t i) {
  const Vector origin = vector(tubes.vertices[tubes.vertex_offsets[i]]);
  double sum = 0;
  for (const auto& t : triangles_of(tubes, i)) {
    const auto at = [&](int k) { return Vector(vector(tubes.vertices[t[k]]) - origin); };
    sum += at(0).dot(at(1).cross(at(2))) / 6;
  }
  return sum;
}

/// Each tube is closed, has the topology of a sphere, uses its own vertices only, and all of them.
void check_watertight(const Tubes& tubes, std::size_t count) {
  REQUIRE(tubes.vertex_offsets.size() == count + 1);
  REQUIRE(tubes.triangle_offsets.size() == count + 1);
  CHECK(tubes.vertex_offsets.back() == static_cast<std::int64_t>(tubes.vertices.size()));
  CHECK(tubes.triangle_offsets.back() == static_cast<std::int64_t>(tubes.triangles.size()));
  for (std::size_t i = 0; i < count; ++i) {
    std::map<std::pair<std::int32_t, std::int32_t>, int> sides;
    std::set<std::int32_t> used;
    const auto triangles = triangles_of(tubes, i);
    for (const auto& t : triangles) {
      for (int k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
      used.insert(t.begin(), t.end());
    }
    for (const auto& [side, times] : sides) {
      CHECK(times == 1);
      CHECK(sides.contains({side.second, side.first}));
    }
    const auto vertex_count = tubes.vertex_offsets[i + 1] - tubes.vertex_offsets[i];
    CHECK(static_cast<std::int64_t>(used.size()) == vertex_count);
    CHECK(*used.begin() == tubes.vertex_offsets[i]);
    CHECK(*used.rbegin() == tubes.vertex_offsets[i + 1] - 1);
    CHECK(vertex_count - static_cast<std::int64_t>(sides.size()) / 2 + static_cast<std::int64_t>(triangles.size()) ==
          2);
  }
}

void check_no_flat_triangle(const Tubes& tubes, double radius) {
  for (const auto& v : tubes.vertices) CHECK(vector(v).allFinite());
  for (const auto& t : tubes.triangles) CHECK(area(tubes, t) > 1e-12 * radius * radius);
}

/// The rings of a tube: its vertices without the two ends.
std::vector<std::vector<Vector>> rings_of(const Tubes& tubes, std::size_t i, int side_count) {
  std::vector<std::vector<Vector>> rings;
  const auto first = tubes.vertex_offsets[i] + 1, last = tubes.vertex_offsets[i + 1] - 1;
  REQUIRE((last - first) % side_count == 0);
  for (auto v = first; v < last; ++v) {
    if ((v - first) % side_count == 0) rings.emplace_back();
    rings.back().push_back(vector(tubes.vertices[v]));
  }
  return rings;
}

Vector mean(const std::vector<Vector>& points) {
  Vector sum = Vector::Zero();
  for (const auto& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

double equation_3(const TubeOptions& options, double arc, double length) {
  if (options.taper_length == 0) return options.radius;
  return options.radius * (1 - std::exp(-arc / options.taper_length)) *
         (1 - std::exp(-(length - arc) / options.taper_length));
}

Placement placed(const SurfaceMesh& mesh, const OrientationField& field, double separation) {
  PlacementOptions options;
  options.separation_distance = separation;
  options.seed_count = 4;
  return place_streamlines(mesh, field, options);
}

}  // namespace

TEST_CASE("tubes: of placed streamlines they are watertight and face outwards, whatever the options") {
  for (const auto& soup : {jittered_grid(10, 8, 0.4), sphere(3, 2), moebius_strip(40, 6)}) {
    const auto mesh = soup.mesh();
    for (const bool smooth : {true, false}) {
      const auto placement = placed(mesh, smooth ? smooth_field(mesh) : random_field(mesh, 3), 0.3);
      for (const TubeOptions options : {TubeOptions{0.07, 0.8, 8}, {0.02, 0, 3}, {0.4, 5, 12}, {1e-4, 0.01, 5}}) {
        const auto tubes = make_tubes(mesh, placement, options);
        check_watertight(tubes, placement.lengths.size());
        check_no_flat_triangle(tubes, 1e-4 * options.radius);
        for (std::size_t i = 0; smooth && options.radius < 0.1 && i < placement.lengths.size(); ++i) {
          CHECK(volume(tubes, i) > 0);
        }
      }
    }
  }
}

TEST_CASE("tubes: each vertex is at the point of its streamline that the line reaches there") {
  const auto mesh = sphere(3, 2).mesh();
  // Points at uneven distances, some too close for a ring of their own.
  const std::vector<double> stops{0, 0.5, 0.5001, 2.5, 2.5003, 2.6, 7};
  std::vector<Vec3> line;
  for (const double x : stops) line.push_back({x, 0, 0});
  const auto placement = drawn({straight(3, 1), line});
  for (const TubeOptions options : {TubeOptions{0.05, 0.6, 8}, {0.05, 0, 5}, {0.05, 20, 3}}) {
    const auto tubes = make_tubes(mesh, placement, options);
    REQUIRE(tubes.vertex_points.size() == tubes.vertices.size());
    for (std::size_t v = 0; v < tubes.vertices.size(); ++v) {
      const auto point = tubes.vertex_points[v];
      const auto p = std::min(static_cast<std::size_t>(point), placement.points.size() - 2);
      const double share = point - static_cast<double>(p);
      const double x = (1 - share) * placement.points[p][0] + share * placement.points[p + 1][0];
      CHECK(tubes.vertices[v][0] == doctest::Approx(x).epsilon(1e-9));
      CHECK((point >= 4) == (static_cast<std::int64_t>(v) >= tubes.vertex_offsets[1]));
    }
  }
}

TEST_CASE("tubes: every ring has the radius of equation (3) around a point of the line") {
  const auto mesh = sphere(3, 2).mesh();
  const auto placement = placed(mesh, smooth_field(mesh), 0.4);
  for (const TubeOptions options : {TubeOptions{0.05, 0.6, 8}, {0.05, 0, 5}, {0.05, 2, 3}}) {
    const auto tubes = make_tubes(mesh, placement, options);
    for (std::size_t i = 0; i < placement.lengths.size(); ++i) {
      double arc = 0;
      Vector before = vector(placement.points[placement.offsets[i]]);
      CHECK((vector(tubes.vertices[tubes.vertex_offsets[i]]) - before).norm() == 0);
      for (const auto& ring : rings_of(tubes, i, options.side_count)) {
        const Vector middle = mean(ring);
        arc += (middle - before).norm();
        before = middle;
        for (const auto& p : ring) {
          // Leaving out points that are too close for rings shortens the way by next to nothing.
          CHECK((p - middle).norm() == doctest::Approx(equation_3(options, arc, placement.lengths[i])).epsilon(1e-3));
        }
      }
    }
  }
}

TEST_CASE("tubes: rings of a straight line are regular polygons across it, exactly") {
  const auto mesh = one_triangle().mesh();
  for (const int side_count : {3, 4, 7, 12}) {
    const TubeOptions options{0.18, 2, side_count};
    const auto tubes = make_tubes(mesh, drawn({straight(40, 0.25)}), options);
    const auto rings = rings_of(tubes, 0, side_count);
    CHECK(rings.size() == 39);
    for (std::size_t i = 0; i < rings.size(); ++i) {
      const double arc = 0.25 * static_cast<double>(i + 1), radius = equation_3(options, arc, 10);
      for (int k = 0; k < side_count; ++k) {
        const Vector offset = rings[i][k] - Vector(arc, 0, 0);
        CHECK(std::abs(offset.x()) < 1e-14);
        CHECK(std::abs(offset.norm() - radius) < 1e-15);
        const double side = (rings[i][(k + 1) % side_count] - rings[i][k]).norm();
        CHECK(std::abs(side - 2 * radius * std::sin(pi / side_count)) < 1e-15);
      }
      CHECK((rings[i][0] - Vector(arc, 0, radius)).norm() < 1e-14);  // the first corner lies along the normal
    }
  }
}

TEST_CASE("tubes: of less height than width they are the round ones, flattened towards the surface") {
  const auto flat_mesh = one_triangle().mesh(), ball = sphere(3, 2).mesh();
  const auto line = drawn({straight(40, 0.25)}), around = placed(ball, smooth_field(ball), 0.4);
  for (const double height : {1e-3, 0.3, 0.7}) {
    for (const auto& [mesh, placement] : {std::pair(&flat_mesh, &line), std::pair(&ball, &around)}) {
      const auto round = make_tubes(*mesh, *placement, {0.1, 0.5, 6});
      const auto flat = make_tubes(*mesh, *placement, {0.1, 0.5, 6, height});
      check_watertight(flat, placement->lengths.empty() ? 1 : placement->lengths.size());
      CHECK(flat.triangles == round.triangles);
      CHECK(flat.vertex_points == round.vertex_points);
      for (std::size_t i = 0; i + 1 < placement->offsets.size(); ++i) {
        const auto wide = rings_of(round, i, 6), low = rings_of(flat, i, 6);
        for (std::size_t r = 0; r < wide.size(); ++r) {
          const Vector middle = mean(wide[r]), up = wide[r][0] - middle;  // the first corner lies along the normal
          for (int k = 0; k < 6; ++k) {
            const Vector offset = wide[r][k] - middle, along = up * (offset.dot(up) / up.squaredNorm());
            CHECK((low[r][k] - middle - (offset + (height - 1) * along)).norm() < 1e-13);
          }
        }
      }
    }
  }
}

TEST_CASE("tubes: corners do not twist from ring to ring, not even where the surface changes sides") {
  for (const auto& soup : {sphere(3, 2), moebius_strip(40, 6)}) {
    const auto mesh = soup.mesh();
    const auto placement = placed(mesh, smooth_field(mesh), 0.2);
    const TubeOptions options{0.05, 0.6, 6};
    const auto tubes = make_tubes(mesh, placement, options);
    for (std::size_t i = 0; i < placement.lengths.size(); ++i) {
      const auto rings = rings_of(tubes, i, 6);
      for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
        const Vector here = rings[r][0] - mean(rings[r]), next = rings[r + 1][0] - mean(rings[r + 1]);
        CHECK(here.normalized().dot(next.normalized()) > std::cos(pi / 6));
        // On a sphere the normal is known: the first corner lies over the line.
        const bool is_sphere = mesh.components()[0].orientable;
        if (is_sphere) CHECK(here.normalized().dot(mean(rings[r]).normalized()) > 0.97);
      }
    }
  }
}

TEST_CASE("tubes: blunt ends are flat and as wide as the rest") {
  const auto mesh = one_triangle().mesh();
  const auto tubes = make_tubes(mesh, drawn({straight(5, 1)}), {0.2, 0, 8});
  check_watertight(tubes, 1);
  const double polygon = 8 * 0.2 * 0.2 * std::sin(2 * pi / 8) / 2;
  CHECK(volume(tubes, 0) == doctest::Approx(5 * polygon).epsilon(1e-13));
  for (const auto& v : tubes.vertices) CHECK((v[0] >= 0 && v[0] <= 5));
}

TEST_CASE("tubes: the volume is the integral of the polygon's area") {
  const auto mesh = one_triangle().mesh();
  const TubeOptions options{0.18, 2, 12};
  const int segments = 2000;
  const double length = 10, step = length / segments;
  const auto tubes = make_tubes(mesh, drawn({straight(segments, step)}), options);
  double expected = 0;
  for (int i = 0; i < 20000; ++i) {
    const double radius = equation_3(options, (i + 0.5) * length / 20000, length);
    expected += 12 * radius * radius * std::sin(2 * pi / 12) / 2 * length / 20000;
  }
  CHECK(volume(tubes, 0) == doctest::Approx(expected).epsilon(1e-4));
}

TEST_CASE("tubes: one long segment is filled up, so that the taper shows") {
  const auto mesh = one_triangle().mesh();
  const TubeOptions options{0.18, 2, 6};
  const auto tubes = make_tubes(mesh, drawn({straight(1, 40)}), options);
  check_watertight(tubes, 1);
  const auto rings = rings_of(tubes, 0, 6);
  CHECK(rings.size() >= 39);
  for (const auto& ring : rings) {
    CHECK((ring[0] - mean(ring)).norm() == doctest::Approx(equation_3(options, mean(ring).x(), 40)).epsilon(1e-13));
  }
}

TEST_CASE("tubes: short lines, down to rounding, are closed bodies") {
  const auto mesh = one_triangle().mesh();
  for (const double length : {1e-9, 1e-6, 1e-3, 0.1}) {
    for (const int segments : {1, 2, 3, 50}) {
      for (const double taper_length : {0.0, 2.0}) {
        const auto tubes = make_tubes(mesh, drawn({straight(segments, length / segments)}), {0.18, taper_length, 5});
        check_watertight(tubes, 1);
        CHECK(volume(tubes, 0) > 0);
        for (const auto& v : tubes.vertices) {
          CHECK(vector(v).allFinite());
          CHECK(std::hypot(v[1], v[2]) <= 0.18 * (1 + 1e-12));
        }
      }
    }
  }
}

TEST_CASE("tubes: a line of which segments have no length is closed all the same") {
  const auto mesh = one_triangle().mesh();
  auto line = straight(6, 0.5);
  line.insert(line.begin() + 3, line[3]);
  line.insert(line.begin(), line[0]);
  line.push_back(line.back());
  const auto tubes = make_tubes(mesh, drawn({line}), {0.1, 0.4, 6});
  check_watertight(tubes, 1);
  check_no_flat_triangle(tubes, 0.01);
  CHECK(volume(tubes, 0) > 0);
}

TEST_CASE("tubes: sharp bends, U-turns among them, leave no triangle without an area") {
  const auto mesh = one_triangle().mesh();
  for (const double angle : {0.5, 1.0, pi / 2, 2.5, 3.0, 3.1, pi - 1e-7, pi}) {
    const std::vector<Vec3> bent{{0, 0, 0}, {1, 0, 0}, {1 + std::cos(angle), std::sin(angle), 0}};
    std::vector<Vec3> zigzag;
    for (int i = 0; i < 12; ++i) zigzag.push_back({0.3 * (i % 2), 0.3 * i * std::cos(angle / 2), 0});
    for (const TubeOptions options : {TubeOptions{0.1, 0.5, 8}, {0.1, 0, 3}, {0.4, 0.3, 5}}) {
      const auto tubes = make_tubes(mesh, drawn({bent, zigzag}), options);
      CAPTURE(angle);
      check_watertight(tubes, 2);
      check_no_flat_triangle(tubes, options.radius);
    }
  }
}

TEST_CASE("tubes: a line along the normal of the surface has a frame, too") {
  const auto mesh = one_triangle().mesh();
  const auto tubes = make_tubes(mesh, drawn({{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}}), {0.1, 0.5, 6});
  check_watertight(tubes, 1);
  check_no_flat_triangle(tubes, 0.1);
  CHECK(volume(tubes, 0) > 0);
}

TEST_CASE("tubes: of no line there is none") {
  const auto tubes = make_tubes(one_triangle().mesh(), drawn({}));
  CHECK(tubes.vertices.empty());
  CHECK(tubes.triangles.empty());
  check_watertight(tubes, 0);
}

TEST_CASE("tubes: options out of range are refused") {
  const auto mesh = one_triangle().mesh();
  const auto placement = drawn({straight(2, 1)});
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const auto refused = [&](const TubeOptions& options) {
    CHECK_THROWS_AS(make_tubes(mesh, placement, options), InvalidOption);
  };
  for (const double radius : {0.0, -1.0, nan, infinity}) refused({radius});
  for (const double taper_length : {-1e-9, nan, infinity}) refused({0.1, taper_length});
  for (const int side_count : {2, 13, 0, -8}) refused({0.1, 1, side_count});
  for (const double height : {0.0, -0.5, 1.001, nan, infinity}) refused({0.1, 1, 8, height});
}

}  // namespace pectinate::test
