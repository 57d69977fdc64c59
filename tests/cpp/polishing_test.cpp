// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "detail/occupancy_layers.hpp"
#include "hard_fields.hpp"
#include "placement_checks.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;

PlacementOptions polished(double separation, std::int64_t rounds) {
  PlacementOptions options;
  options.separation_distance = separation;
  options.polishing_rounds = rounds;
  return options;
}

/// Of the lines as they were placed: to run on into the chords ahead is no matter of polishing.
double total_as_placed(const Placement& placement) {
  const auto lengths = as_placed(placement).lengths;
  return std::accumulate(lengths.begin(), lengths.end(), 0.0);
}
void check_no_worse(const Placement& better, const Placement& plain) {
  const double before = total_as_placed(plain), after = total_as_placed(better);
  const auto count = [](const Placement& placement) { return static_cast<double>(placement.lengths.size()); };
  CHECK(after / count(better) >= before / count(plain) * (1 - 1e-12));
  CHECK(after >= before * (1 - 1e-12));
  CHECK(better.statistics.coverage >= plain.statistics.coverage - 1e-6);
}

/// All that is promised, and no worse than before in what polishing is for. Returns both.
std::pair<Placement, Placement> check_polished(const SurfaceMesh& mesh, const OrientationField& field,
                                               const PlacementOptions& options) {
  auto plain_options = options;
  plain_options.polishing_rounds = 0;
  auto plain = checked(mesh, field, plain_options), better = checked(mesh, field, options);
  CHECK(plain.statistics.polishing_rounds == 0);
  check_no_worse(better, plain);
  if (options.separation_distances.empty()) {
    check_segment_separation(better, options.test_distance * options.separation_distance);
    if (options.test_distance == 1) check_self_separation(better, options.separation_distance);
    check_ends_near_others(better);
  }
  return {std::move(plain), std::move(better)};
}

}  // namespace

TEST_CASE("polishing: whatever the field and the separation distance, what was promised stays") {
  const auto mesh = jittered_grid(12, 9).mesh();
  for (const auto& hard : hard_fields) {
    CAPTURE(hard.name);
    const auto field = make_field(mesh, hard);
    for (const double separation : {0.31, 1.0, 4.0}) {
      CAPTURE(separation);
      const auto better = check_polished(mesh, field, polished(separation, 40)).second;
      check_complete(mesh, field, better, 10);
      CHECK(better.statistics.coverage > 1 - 1e-6);
      CHECK((better.statistics.polishing_rounds == 40 || better.lengths.size() == 1));
    }
  }
}

TEST_CASE("polishing: with clearances, and with closed lines") {
  const auto mesh = jittered_grid(12, 9).mesh();
  for (const auto& hard : hard_fields) {
    CAPTURE(hard.name);
    const auto field = make_field(mesh, hard);
    auto wider = polished(0.4, 60);
    wider.seed_clearance = 1.16;
    auto nearer = polished(0.4, 60);
    nearer.test_distance = 0.8;
    auto closing = polished(0.4, 60);
    closing.close_loops = true;
    for (const auto& options : {wider, nearer, closing}) {
      const auto better = check_polished(mesh, field, options).second;
      check_complete(mesh, field, better, 10);
      check_room_to_start(better);
    }
  }
}

TEST_CASE("polishing: with a minimum length, and out of singular places") {
  const auto mesh = jittered_grid(12, 9).mesh();
  for (const auto& hard : hard_fields) {
    CAPTURE(hard.name);
    const auto field = make_field(mesh, hard);
    auto options = polished(0.4, 60);
    options.minimum_length = 0.7;
    const auto longer = place_streamlines(mesh, field, options);
    for (const double length : longer.lengths) CHECK(length >= 0.7 * (1 - 1e-6));
    check_segment_separation(longer, 0.4);
    check_ends_near_others(longer);
    options.minimum_length = 0;
    options.singularity_radius = 0.3;
    const auto better = check_polished(mesh, field, options).second;
    CHECK(better.statistics.coverage > 1 - 1e-6);
  }
}

TEST_CASE("polishing: closed lines stay and are found") {
  const auto mesh = annulus(60, 12, 1, 4).mesh();
  const auto field = field_of(mesh, [](const Vector& c, const Vector&) { return Vector(-c.y(), c.x(), 0); });
  auto options = polished(0.35, 50);
  options.close_loops = true;
  const auto [plain, better] = check_polished(mesh, field, options);
  CHECK(stop_count(better, StopReason::closed) > 0);
  for (std::size_t i = 0; i < better.lengths.size(); ++i) {
    if (is_closed(better, i)) CHECK(better.points[better.offsets[i]] == better.points[better.offsets[i + 1] - 1]);
  }
}

TEST_CASE("polishing: a separation distance that varies") {
  const auto mesh = jittered_grid(16, 12).mesh();
  const auto field = smooth_field(mesh);
  auto options = polished(1, 100);
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    options.separation_distances.push_back(0.3 + 0.3 * std::sin(centre(mesh, t).x()) * std::sin(centre(mesh, t).x()));
  }
  const auto better = check_polished(mesh, field, options).second;
  check_complete(mesh, field, better, 10);
  const auto segments = segments_of(better);
  for (const auto& later : segments) {
    for (const auto& earlier : segments) {
      if (earlier.line >= later.line || later.is_farther_than(earlier, earlier.separation_distance)) continue;
      CHECK(later.distance(earlier) >= earlier.separation_distance);
    }
  }
}

TEST_CASE("polishing: more rounds are never worse, and many are better") {
  const auto mesh = sphere(4, 4).mesh();
  const auto field = smooth_field(mesh);
  const auto plain = place_streamlines(mesh, field, polished(0.4, 0));
  auto last = plain;
  for (const std::int64_t rounds : {20, 40, 80, 160, 320}) {
    const auto placement = place_streamlines(mesh, field, polished(0.4, rounds));
    CHECK(placement.statistics.polishing_rounds == rounds);
    check_no_worse(placement, plain);
    CHECK(total_as_placed(placement) / double(placement.lengths.size()) >=
          total_as_placed(last) / double(last.lengths.size()) * (1 - 1e-12));
    last = placement;
  }
  CHECK(last.statistics.mean_length > 1.03 * plain.statistics.mean_length);
}

TEST_CASE("polishing: a line that winds round all the surface gives way to those that fill what it leaves") {
  const double radius = 20, tube = 8, turns = std::sqrt(2.0);
  const auto mesh = torus(160, 50, radius, tube).mesh();
  const auto field = field_of(mesh, [&](const Vector& c, const Vector&) {
    const double out = std::hypot(c.x(), c.y());
    const Vector around = Vector(-c.y(), c.x(), 0) / out, from_core = c - radius / out * Vector(c.x(), c.y(), 0);
    return Vector(out * around + turns * around.cross(from_core));
  });
  const auto [plain, better] = check_polished(mesh, field, polished(1.2, 20));
  CHECK(std::ranges::max(plain.lengths) > 10 * plain.statistics.mean_length);
  CHECK(better.statistics.mean_length > 1.4 * plain.statistics.mean_length);
}

TEST_CASE("polishing: lines that fill a strip from side to side are left as they are") {
  const auto mesh = grid(12, 9).mesh();
  const auto field = constant_field(mesh, Vector(1, 0.01, 0));
  const auto [plain, better] = check_polished(mesh, field, polished(0.9, 50));
  CHECK(better.statistics.streamline_count <= plain.statistics.streamline_count);
}

TEST_CASE("polishing: the bytes depend on the rounds and the random seed, not on threads or signs") {
  const auto mesh = jittered_grid(16, 12).mesh();
  const auto field = smooth_field(mesh);
  auto options = polished(0.3, 150);
  const auto once = place_streamlines(mesh, field, options);
  CHECK(same_bytes(once, place_streamlines(mesh, field, options)));
  options.thread_count = 3;
  CHECK(same_bytes(once, place_streamlines(mesh, field, options)));
  options.random_seed = 1;
  CHECK(!same_bytes(once, place_streamlines(mesh, field, options)));
}

TEST_CASE("polishing: reversing any of the vectors changes no byte") {
  const auto mesh = jittered_grid(16, 12).mesh();
  const auto vectors =
      triangle_vectors(mesh, [](const Vector& c, const Vector&) { return Vector(c.y() + 0.1, std::sin(c.x()), 0); });
  auto reversed = vectors;
  for (std::size_t t = 0; t < vectors.size(); t += 3) {
    for (auto& part : reversed[t]) part = -part;
  }
  const auto placed = [&](const std::vector<Vec3>& rows) {
    return place_streamlines(mesh, OrientationField::from_triangle_vectors(mesh, rows), polished(0.3, 100));
  };
  CHECK(same_bytes(placed(vectors), placed(reversed)));
}

TEST_CASE("polishing: so many rounds as there was time for give the same bytes") {
  const auto mesh = jittered_grid(16, 12).mesh();
  const auto field = smooth_field(mesh);
  auto options = polished(0.3, 0);
  const auto plain = place_streamlines(mesh, field, options);
  options.polishing_time = 1e-9;  // over before it begins
  const auto too_short = place_streamlines(mesh, field, options);
  CHECK(too_short.statistics.polishing_rounds == 0);
  CHECK(same_bytes(too_short, plain));
  options.polishing_time = 0.03;
  const auto by_time = place_streamlines(mesh, field, options);
  REQUIRE(by_time.statistics.polishing_rounds > 0);
  CHECK(same_bytes(by_time, place_streamlines(mesh, field, polished(0.3, by_time.statistics.polishing_rounds))));
  options.polishing_rounds = 5;
  options.polishing_time = 1000;
  const auto by_rounds = place_streamlines(mesh, field, options);
  CHECK(by_rounds.statistics.polishing_rounds == 5);
}

TEST_CASE("polishing: cancelled, it returns whole lines, no worse than without it") {
  const auto mesh = sphere(4, 10).mesh();
  const auto field = smooth_field(mesh);
  const auto plain = place_streamlines(mesh, field, polished(0.5, 0));
  auto options = polished(0.5, std::numeric_limits<std::int64_t>::max());
  options.progress = [](double coverage) { return coverage < 1 - 1e-6; };
  const auto placement = place_streamlines(mesh, field, options);
  CHECK(placement.end == PlacementEnd::cancelled);
  check_no_worse(placement, plain);
  check_lines(mesh, field, placement);
  check_points(mesh, placement);
  check_statistics(mesh, field, placement);
  check_segment_separation(placement, 0.5);
  CHECK(placement.statistics.coverage == doctest::Approx(plain.statistics.coverage).epsilon(1e-6));
}

TEST_CASE("polishing: every kind of surface, and a field without any order") {
  for (const auto& soup : {sphere(3), torus(24, 12), moebius_strip(40, 6), klein_bottle(30, 16),
                           together(jittered_grid(9, 7), moved(sphere(2), {20, 0, 0})), three_on_an_edge()}) {
    const auto mesh = soup.mesh();
    for (const auto& field : {smooth_field(mesh), random_field(mesh, 3)}) {
      auto options = polished(0.35, 60);
      const auto better = checked(mesh, field, options);
      check_ends_near_others(better);
      options.polishing_rounds = 0;
      check_no_worse(better, place_streamlines(mesh, field, options));
    }
  }
}

TEST_CASE("polishing: it ends, even where squares of lengths overflow or vanish") {
  for (const double scale : {1e-75, 1e-40, 1e40, 1e76, 1e77}) {
    CAPTURE(scale);
    const auto mesh = mapped(jittered_grid(6, 5), [=](const Vector& v) { return Vector(scale * v); }).mesh();
    const auto field = constant_field(mesh, Vector(1, 0.3, 0));
    const auto placement = place_streamlines(mesh, field, polished(1.5 * scale, 20));
    CHECK(placement.end == PlacementEnd::complete);
    CHECK(!placement.lengths.empty());
  }
}

TEST_CASE("polishing: one line, or none, ends at once") {
  const auto most = std::numeric_limits<std::int64_t>::max();
  const auto mesh = jittered_grid(5, 4).mesh();
  const auto field = smooth_field(mesh);
  CHECK(place_streamlines(mesh, field, polished(50, most)).statistics.polishing_rounds == 0);
  auto options = polished(0.5, most);
  options.minimum_length = 100;
  CHECK(place_streamlines(mesh, field, options).lengths.empty());
}

}  // namespace pectinate::test
