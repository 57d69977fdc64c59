// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "detail/chord_sides.hpp"
#include "detail/chord_tracer.hpp"
#include "placement_checks.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;

/// Lines that wind round the torus golden ratio times while they run around it once: never twice the same way.
OrientationField helices(const SurfaceMesh& mesh) {
  return field_of(mesh, [](const Vector& c, const Vector& normal) -> Vector {
    const Vector around(-c.y(), c.x(), 0);
    return around + std::numbers::phi * 0.7 * normal.cross(around).normalized();
  });
}

PlacementOptions with(double separation) {
  PlacementOptions options;
  options.separation_distance = separation;
  return options;
}

}  // namespace

TEST_CASE("long lines: they are even and complete, whatever candidates are left out beside them") {
  const auto mesh = torus(100, 40).mesh();
  const auto field = helices(mesh);
  for (const double separation : {0.15, 0.3}) {
    const auto placement = checked(mesh, field, with(separation));
    std::int64_t most = 0;  // chords of a line
    for (std::size_t i = 0; i < placement.lengths.size(); ++i) {
      most = std::max(most, placement.offsets[i + 1] - placement.offsets[i] - 1);
    }
    CHECK(most > 1024);
    check_segment_separation(placement, separation);
    check_self_separation(placement, separation);
    check_complete(mesh, field, placement, 10);
  }
}

TEST_CASE("long lines: parallel ones lie as close as they may, on both sides of each") {
  const auto mesh = grid(600, 12).mesh();
  const auto field = constant_field(mesh, Vector(1, 0, 0));
  for (const double separation : {0.3, 0.6, 1.0, 1.5, 3.0}) {
    const auto& statistics = place_streamlines(mesh, field, with(separation)).statistics;
    CHECK(statistics.mean_length == doctest::Approx(600).epsilon(1e-9));
    CHECK(statistics.mean_spacing <= 1.005 * separation);
  }
}

TEST_CASE("long lines: separation distances that are all the same are one") {
  const auto mesh = torus(200, 80).mesh();
  const auto field = helices(mesh);
  auto options = with(0.3);
  const auto same = place_streamlines(mesh, field, options);
  options.separation_distances.assign(mesh.triangle_count(), 0.3);
  CHECK(same_bytes(same, place_streamlines(mesh, field, options)));
}

TEST_CASE("long lines: what a spiral leaves of itself is no nearer to itself than the rest") {
  const auto mesh = jittered_grid(60, 60).mesh();
  for (const double slope : {0.01, 0.03, 0.06}) {
    const auto field = field_of(mesh, [&](const Vector& c, const Vector&) -> Vector {
      const Vector out(c.x() - 30.1, c.y() - 29.8, 0);
      return Vector(-out.y(), out.x(), 0) + slope * out;
    });
    for (const double separation : {2.5, 4.0, 7.0}) {
      const auto placement = checked(mesh, field, with(separation));
      check_segment_separation(placement, separation);
      check_self_separation(placement, separation);
      check_complete(mesh, field, placement, 10);
    }
  }
}

TEST_CASE("long lines: what comes far ends where it has come back to itself") {
  const auto mesh = torus(200, 80).mesh();
  const auto field = helices(mesh);
  for (const double separation : {0.3, 0.5}) {
    const StreamlineTracer tracer(mesh, field, {separation});
    const detail::ChordOccupancy occupancy(mesh, tracer, {});
    detail::ChordTracer chord_tracer(tracer, occupancy, {});
    detail::Chords chords;
    const auto ends = chord_tracer.trace({0, 0.5}, {}, chords);
    CHECK((ends[0] == StopReason::near_itself && ends[1] == StopReason::near_itself));

    std::vector<Vector> points;
    const auto& sheet = tracer.sheet();
    detail::visit_points(sheet, chords, false, [&](const Vector& point) { points.push_back(point); });
    std::vector<double> arc{0};
    for (std::size_t i = 1; i < points.size(); ++i) arc.push_back(arc.back() + (points[i] - points[i - 1]).norm());
    // If the first or the last point comes near another, then because of criterion 5.
    for (const auto end : {std::size_t{0}, points.size() - 1}) {
      double least = separation;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (std::abs(arc[i] - arc[end]) > 2 * separation) least = std::min(least, (points[i] - points[end]).norm());
      }
      CHECK(least < separation);
    }
    // Lines d_sep apart would be as long as area / d_sep.
    CHECK(arc.back() < 2 * mesh.area() / separation);
    CHECK(arc.back() > 64 * separation);
  }
}

}  // namespace pectinate::test
