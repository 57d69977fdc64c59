// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "hard_fields.hpp"
#include "pectinate/tubes.hpp"
#include "placement_checks.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;
using detail::vector;
using std::numbers::pi;

PlacementOptions closing(double separation) {
  PlacementOptions options;
  options.separation_distance = separation;
  options.close_loops = true;
  return options;
}

/// Round the z axis, and away from it by so much as the function of the distance from it says.
template <class Function>
OrientationField swirl(const SurfaceMesh& mesh, const Function& outwards) {
  return field_of(mesh, [&](const Vector& c, const Vector&) {
    const Vector away = Vector(c.x(), c.y(), 0).normalized();
    return Vector(Vector(-away.y(), away.x(), 0) + outwards(std::hypot(c.x(), c.y())) * away);
  });
}

/// Moved so that the z axis runs through the middle of a square of side 6.
Soup centred(const Soup& square) {
  return moved(square, {-3, -3, 0});
}

/// Closed lines end where they begin, bit for bit, and are long enough; others do not say that they are closed.
Placement check_closed(const SurfaceMesh& mesh, const OrientationField& field, const PlacementOptions& options) {
  auto placement = checked(mesh, field, options);
  for (std::size_t i = 0; i < placement.lengths.size(); ++i) {
    const auto &first = placement.points[placement.offsets[i]], &last = placement.points[placement.offsets[i + 1] - 1];
    CHECK(is_closed(placement, i) == (first == last));
    CHECK(is_closed(placement, i) == (placement.stop_reasons[i][1] == StopReason::closed));
    if (is_closed(placement, i)) CHECK(placement.lengths[i] >= 4 * options.separation_distance * (1 - 1e-6));
  }
  check_segment_separation(placement, options.separation_distance);
  check_self_separation(placement, options.separation_distance);
  return placement;
}

std::int64_t closed_count(const Placement& placement) {
  return stop_count(placement, StopReason::closed) / 2;
}

Vector mean_of(const Tubes& tubes, std::int64_t first, int count) {
  Vector sum = Vector::Zero();
  for (int k = 0; k < count; ++k) sum += vector(tubes.vertices[first + k]);
  return sum / count;
}

/// Tubes of closed lines are watertight rings.
void check_topology(const Tubes& tubes, std::size_t i) {
  const auto first = tubes.vertex_offsets[i], last = tubes.vertex_offsets[i + 1];
  const auto sides = tubes.triangle_offsets[i + 1] - tubes.triangle_offsets[i];
  CHECK(sides == 2 * (last - first));  // Euler characteristic 0, if watertight: 3/2 edges a triangle
  std::vector<std::pair<std::int32_t, std::int32_t>> edges;
  for (auto t = tubes.triangle_offsets[i]; t < tubes.triangle_offsets[i + 1]; ++t) {
    const auto& corners = tubes.triangles[t];
    for (int k = 0; k < 3; ++k) edges.emplace_back(corners[k], corners[(k + 1) % 3]);
  }
  std::sort(edges.begin(), edges.end());
  CHECK(std::adjacent_find(edges.begin(), edges.end()) == edges.end());
  for (const auto& [from, to] : edges) CHECK(std::binary_search(edges.begin(), edges.end(), std::pair{to, from}));
}

/// They are as thick everywhere, and turn little from one station to the next.
void check_ring(const Tubes& tubes, std::size_t i, const TubeOptions& options) {
  check_topology(tubes, i);
  const auto first = tubes.vertex_offsets[i], last = tubes.vertex_offsets[i + 1];
  const int n = options.side_count;
  const auto count = (last - first) / n;
  for (std::int64_t ring = 0; ring < count; ++ring) {
    const auto here = first + n * ring, next = first + n * ((ring + 1) % count);
    const Vector centre_here = mean_of(tubes, here, n), centre_next = mean_of(tubes, next, n);
    for (int k = 0; k < n; ++k) {
      const Vector from = vector(tubes.vertices[here + k]) - centre_here;
      const Vector to = vector(tubes.vertices[next + k]) - centre_next;
      CHECK(from.norm() == doctest::Approx(options.radius).epsilon(1e-9));
      CHECK((to - from).norm() < 0.7 * options.radius);
    }
  }
}

void check_rings(const SurfaceMesh& mesh, const Placement& placement) {
  for (const TubeOptions options : {TubeOptions{0.05, 1, 8}, {0.01, 0, 3}}) {
    const auto tubes = make_tubes(mesh, placement, options);
    for (std::size_t i = 0; i < placement.lengths.size(); ++i) {
      if (is_closed(placement, i)) check_ring(tubes, i, options);
    }
  }
}

}  // namespace

TEST_CASE("closed loops: round a cylinder every line closes, as long as its polygon") {
  const int around = 24;
  const auto mesh = cylinder(around, 15, 2, 6).mesh();
  const auto field = swirl(mesh, [](double) { return 0.0; });
  const double circumference = around * 2 * 2 * std::sin(pi / around);
  for (const double separation : {0.3, 0.45, 1.4}) {
    const auto placement = check_closed(mesh, field, closing(separation));
    CHECK(closed_count(placement) == placement.statistics.streamline_count);
    CHECK(placement.statistics.streamline_count >= std::floor(6 / separation) - 1);
    for (const double length : placement.lengths) CHECK(length == doctest::Approx(circumference).epsilon(1e-9));
    for (const auto& segment : segments_of(placement)) CHECK(std::abs(segment.start.z() - segment.end.z()) < 3e-8);
    check_complete(mesh, field, placement);
    check_rings(mesh, placement);
  }
  // From 4 d_sep on a ring is a streamline.
  CHECK(closed_count(check_closed(mesh, field, closing(circumference / 4.001))) > 0);
  CHECK(closed_count(check_closed(mesh, field, closing(circumference / 3.999))) == 0);
  auto options = closing(0.45);
  options.minimum_length = circumference - 0.01;
  CHECK(closed_count(check_closed(mesh, field, options)) >= 12);
  options.minimum_length = circumference + 0.01;
  CHECK(place_streamlines(mesh, field, options).lengths.empty());
  options = closing(0.45);
  options.close_loops = false;
  CHECK(closed_count(check_closed(mesh, field, options)) == 0);
}

TEST_CASE("closed loops: a tube has rings enough, however thick it is for its line") {
  const auto mesh = grid(1, 1).mesh();
  Placement placement;
  placement.points = {{0.2, 0.4, 0}, {0.65, 0.45, 0}, {0.2, 0.5, 0}, {0.2, 0.4, 0}};
  placement.segment_triangles = {0, 0, 0};
  placement.offsets = {0, 4};
  for (const double radius : {0.01, 0.3, 3.0}) {
    const auto tubes = make_tubes(mesh, placement, {radius, 0, 5});
    check_topology(tubes, 0);
    CHECK(tubes.vertices.size() >= 3 * 5);
  }
}

TEST_CASE("closed loops: they too begin only where the clearance for seeds is free") {
  const auto mesh = cylinder(24, 15, 2, 6).mesh();
  const auto field = swirl(mesh, [](double) { return 0.0; });
  auto options = closing(1);
  options.seed_clearance = 1.5;
  const auto placement = check_closed(mesh, field, options);
  CHECK(closed_count(placement) >= 3);
  check_room_to_start(placement);
}

TEST_CASE("closed loops: spirals and helices do not close") {
  const auto flat = annulus(48, 20, 1, 3).mesh();
  for (const double pitch : {0.02, 0.06, -0.2}) {
    const auto placement = check_closed(flat, swirl(flat, [=](double r) { return pitch * r; }), closing(0.2));
    CHECK(closed_count(placement) == 0);
    CHECK(placement.statistics.coverage > 1 - 1e-6);
  }
  const auto mesh = cylinder(24, 15, 2, 6).mesh();
  for (const double rise : {0.001, 0.05}) {
    const auto helix = field_of(mesh, [=](const Vector& c, const Vector&) {
      return Vector(Vector(-c.y(), c.x(), 0).normalized() + Vector(0, 0, rise));
    });
    CHECK(closed_count(check_closed(mesh, helix, closing(0.3))) == 0);
  }
}

TEST_CASE("closed loops: a limit cycle is found where it is, from within and from without") {
  const auto mesh = centred(jittered_grid(80, 80, 0.075)).mesh();
  for (const double attraction : {0.1, 0.3, -0.1, -0.3}) {
    for (const double radius : {1.6, 2.3}) {
      CAPTURE(attraction);
      CAPTURE(radius);
      const auto field = swirl(mesh, [=](double r) { return attraction * (radius - r); });
      for (const double separation : {0.3, 0.15}) {
        const auto placement = check_closed(mesh, field, closing(separation));
        // It comes first, whatever else winds onto it.
        REQUIRE(closed_count(placement) == 1);
        REQUIRE(is_closed(placement, 0));
        CHECK(placement.lengths[0] == doctest::Approx(2 * pi * radius).epsilon(0.005));
        for (auto p = placement.offsets[0]; p < placement.offsets[1]; ++p) {
          CHECK(std::abs(vector(placement.points[p]).norm() - radius) < 0.003 / std::abs(attraction) + 0.005);
        }
        check_rings(mesh, placement);
      }
    }
  }
}

TEST_CASE("closed loops: the core of a Moebius strip closes, and its tube too") {
  const auto lengths = [&](int rows, double separation) {
    const auto mesh = moebius_strip(60, rows).mesh();
    const auto placement = check_closed(mesh, swirl(mesh, [](double) { return 0.0; }), closing(separation));
    check_rings(mesh, placement);
    std::vector<double> closed;
    for (std::size_t i = 0; i < placement.lengths.size(); ++i) {
      if (is_closed(placement, i)) closed.push_back(placement.lengths[i]);
    }
    return closed;
  };
  // Once round through the middle; twice round beside it.
  const auto core = lengths(5, 1);
  REQUIRE(core.size() == 1);
  CHECK(core[0] == doctest::Approx(4 * pi).epsilon(0.01));
  const auto beside = lengths(7, 0.2);
  REQUIRE(beside.size() == 2);
  for (const double length : beside) CHECK(length == doctest::Approx(8 * pi).epsilon(0.01));
}

TEST_CASE("closed loops: whatever the field, lines keep apart and fill the surface") {
  const auto mesh = jittered_grid(12, 9).mesh();
  std::int64_t closed = 0;
  for (const auto& hard : hard_fields) {
    CAPTURE(hard.name);
    const auto field = make_field(mesh, hard);
    for (const double separation : {0.05, 0.31, 1.0}) {
      for (const double clearance : {1.0, 1.11}) {
        auto options = closing(separation);
        options.seed_clearance = clearance;
        const auto placement = check_closed(mesh, field, options);
        check_complete(mesh, field, placement, 10);
        closed += closed_count(placement);
      }
    }
  }
  CHECK(closed > 10);
}

TEST_CASE("closed loops: they do not depend on signs, and move with the surface") {
  const auto soup = centred(jittered_grid(60, 60, 0.1));
  const auto mesh = soup.mesh();
  const auto outwards = [](double r) { return 0.3 * std::sin(5 * r); };
  const auto field = swirl(mesh, outwards);
  const auto placement = check_closed(mesh, field, closing(0.15));
  REQUIRE(closed_count(placement) >= 2);
  auto vectors = field.directions();
  Random random(5);
  for (auto& vector : vectors) {
    if (random.unit() < 0.5) vector = detail::vec3(-detail::vector(vector));
  }
  const auto reversed = OrientationField::from_triangle_vectors(mesh, vectors);
  const auto straight = OrientationField::from_triangle_vectors(mesh, field.directions());
  CHECK(same_bytes(place_streamlines(mesh, reversed, closing(0.15)), place_streamlines(mesh, straight, closing(0.15))));

  const Vector offset(3, -5, 2);
  const auto moved_mesh = mapped(soup, [&](const Vector& v) { return Vector(some_rotation() * v + offset); }).mesh();
  const auto moved_field = field_of(moved_mesh, [&](const Vector& c, const Vector&) {
    const Vector at = some_rotation().transpose() * (c - offset), away = at.normalized();
    return Vector(some_rotation() * (Vector(-away.y(), away.x(), 0) + outwards(at.norm()) * away));
  });
  const auto moved_placement = place_streamlines(moved_mesh, moved_field, closing(0.15));
  REQUIRE(moved_placement.offsets == placement.offsets);
  CHECK(moved_placement.stop_reasons == placement.stop_reasons);
  for (std::size_t p = 0; p < placement.points.size(); ++p) {
    const Vector expected = some_rotation() * vector(placement.points[p]) + offset;
    CHECK((vector(moved_placement.points[p]) - expected).norm() < 1e-6);
  }
}

}  // namespace pectinate::test
