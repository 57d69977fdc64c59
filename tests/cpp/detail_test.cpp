// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <random>
#include <set>
#include <stdexcept>
#include <thread>

#include "detail/capsule.hpp"
#include "detail/edge_search.hpp"
#include "detail/random.hpp"
#include "detail/seed_ring.hpp"
#include "detail/self_approach.hpp"
#include "detail/sheet.hpp"
#include "detail/thread_pool.hpp"
#include "detail/visited_chords.hpp"
#include "detail/weighted_set.hpp"
#include "lines.hpp"
#include "pectinate/occupancy.hpp"

namespace pectinate::detail {
namespace {

using test::jittered_grid;

Vector draw_vector(Random& random, double size = 1) {
  const double x = random.unit(), y = random.unit(), z = random.unit();
  return size * Vector(2 * x - 1, 2 * y - 1, 2 * z - 1);
}

/// The nearest point is never farther than any sample, nor nearer than the nearest sample by more than their spacing.
void check_distance(const Vector& point, const Vector& start, const Vector& end) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 1000; ++i) least = std::min(least, (start + i / 1000.0 * (end - start) - point).norm());
  const double distance = distance_to_segment(point, start, end);
  CHECK(distance <= least * (1 + 1e-15));
  CHECK(distance >= least - (end - start).norm() / 2000);
}

/// `interval` holds exactly the parameters at which p + t e is inside the capsule.
void check_intersection(const Capsule& capsule, const Vector& p, const Vector& e) {
  const auto interval = intersect(capsule, p, e);
  if (interval) CHECK((0 <= interval->low && interval->low <= interval->high && interval->high <= 1));
  for (int i = 0; i <= 200; ++i) {
    const double t = i / 200.0, distance = distance_to_segment(p + t * e, capsule.start, capsule.end);
    const bool inside = interval && interval->low <= t && t <= interval->high;
    if (std::abs(distance - capsule.radius) > 1e-7 * capsule.radius) CHECK(inside == (distance < capsule.radius));
  }
}

/// The chord that lies at `split` runs through the middle corner; others are shorter in proportion.
void check_chords(const SurfaceMesh& mesh, const OrientationField& field, std::int32_t t,
                  const TriangleCrossings& crossings) {
  CHECK((crossings.split > 0 && crossings.split < 1));
  const Vector direction = vector(field.directions()[t]);
  for (int i = 1; i < 40; ++i) {
    const double chord = i / 40.0;
    const Role other = chord < crossings.split ? low_middle : middle_high;
    const auto from = edge_point(mesh, t, crossings, low_high, chord);
    const auto to = edge_point(mesh, t, crossings, other, chord);
    CHECK(chord_coordinate(crossings, low_high, from.position) == doctest::Approx(chord).epsilon(1e-12));
    CHECK(chord_coordinate(crossings, other, to.position) == doctest::Approx(chord).epsilon(1e-8));
    const Vector step = position(mesh, to) - position(mesh, from);
    CHECK(step.norm() == doctest::Approx(chord_length(crossings, chord)).epsilon(1e-6));
    CHECK(step.cross(direction).norm() < 2e-7 * step.norm() + 1e-8);
  }
}

}  // namespace

TEST_CASE("capsule: the distance to a segment") {
  Random random(1);
  for (int round = 0; round < 100; ++round) {
    check_distance(draw_vector(random, 2), draw_vector(random), draw_vector(random));
  }
  CHECK(distance_to_segment({3, 4, 0}, {0, 0, 0}, {0, 0, 0}) == 5);
  CHECK(distance_to_segment({1, 2, 0}, {0, 0, 0}, {2, 0, 0}) == 2);
}

TEST_CASE("capsule: the part of a segment inside it, by definition") {
  Random random(2);
  for (int round = 0; round < 2000; ++round) {
    const Capsule capsule{draw_vector(random), draw_vector(random), 0.05 + 0.8 * random.unit()};
    check_intersection(capsule, draw_vector(random, 2), draw_vector(random, 2));
  }
}

TEST_CASE("capsule: parallel, crossing, touching and point-like segments") {
  const Capsule along_x{{0, 0, 0}, {2, 0, 0}, 0.5}, ball{{1, 0, 0}, {1, 0, 0}, 0.5};
  Random random(3);
  for (const auto& capsule : {along_x, ball}) {
    for (const double height : {0.0, 0.3, 0.4999, 0.5001, 1.0}) {
      for (const double x : {-4.0, -0.7, 0.0, 0.5, 3.0}) {
        check_intersection(capsule, {x, height, 0}, {3, 0, 0});          // parallel
        check_intersection(capsule, {x, height, 0}, {3, 1e-9, 1e-12});   // almost
        check_intersection(capsule, {x, -2, height}, {0, 4, 0});         // across
        check_intersection(capsule, {x, height, 0}, {0, 0, 0});          // a point
        check_intersection(capsule, {x, height, 0}, {1e-12, 0, 1e-12});  // hardly more
      }
    }
  }
}

TEST_CASE("random: the same numbers everywhere") {
  std::mt19937_64 engine(5489);
  engine.discard(9999);
  REQUIRE(engine() == 9981545732273789042U);  // as the standard demands
  Random random(5489);
  CHECK(random.unit() == static_cast<double>(14514284786278117030U >> 11) * 0x1p-53);
}

TEST_CASE("random: numbers below a bound are even, and reach all values") {
  Random random(1);
  for (const std::uint64_t bound : {1, 2, 3, 7, 64}) {
    std::vector<double> counts(bound, 0);
    for (int i = 0; i < 20000; ++i) counts.at(random.below(bound)) += 1;
    const double expected = 20000.0 / static_cast<double>(bound);
    double chi_square = 0;
    for (const double count : counts) chi_square += (count - expected) * (count - expected) / expected;
    CHECK(chi_square < static_cast<double>(bound) + 5 * std::sqrt(2.0 * static_cast<double>(bound)));
  }
  // A bound above 2^63 rejects almost half of all draws: without that, small numbers would come twice as often.
  const std::uint64_t great = (std::uint64_t{3} << 62) + 1;
  int low = 0;
  for (int i = 0; i < 30000; ++i) low += random.below(great) < great / 3;
  CHECK(std::abs(low - 10000) < 5 * std::sqrt(30000 * 2.0 / 9));
  for (int i = 0; i < 1000; ++i) {
    const double unit = random.unit();
    CHECK((unit >= 0 && unit < 1));
  }
}

TEST_CASE("weighted set: every offset finds the item that a row of all weights has there") {
  Random random(4);
  for (const std::size_t size : {1, 2, 3, 8, 9, 100}) {
    WeightedSet set(size);
    std::vector<std::uint64_t> weights(size, 0);
    for (int round = 0; round < 200; ++round) {
      const auto item = random.below(size);
      weights[item] = random.below(3) == 0 ? 0 : random.below(9);
      set.set(item, weights[item]);
      REQUIRE(set.total() == std::accumulate(weights.begin(), weights.end(), std::uint64_t{0}));
      std::uint64_t offset = 0;
      for (std::size_t i = 0; i < size; ++i) {
        for (std::uint64_t k = 0; k < weights[i]; ++k) CHECK(set.find(offset++) == i);
      }
    }
  }
}

TEST_CASE("self approach: it finds what comparing all points finds") {
  Random random(5);
  SelfApproach grid;
  for (int round = 0; round < 30; ++round) {
    const double distance = 0.02 + 0.2 * random.unit();
    const Vector shift = draw_vector(random, 1000);
    std::vector<std::pair<Vector, double>> points;
    grid.start(distance, shift);
    Vector place = shift;
    int found = 0;
    for (int i = 0; i < 300; ++i) {
      const double arc = (i % 2 ? 1 : -1) * 0.01 * i;
      place += draw_vector(random, 0.15);
      const bool expected = std::any_of(points.begin(), points.end(), [&](const auto& other) {
        return std::abs(other.second - arc) > 2 * distance && (other.first - place).norm() < distance;
      });
      CHECK(grid.is_near(place, arc) == expected);
      found += expected;
      grid.add(place, arc);
      points.emplace_back(place, arc);
    }
    CHECK(found > 0);
  }
}

TEST_CASE("visited chords: a triangle remembers its last chord of this line only") {
  VisitedChords visited;
  visited.start(3);
  CHECK(!visited.revisit(1, 0.5, 2, 0.1));
  CHECK(!visited.revisit(2, 0.5, 2, 0.1));
  CHECK(!visited.revisit(1, 0.56, 2, 0.1));  // 0.12 away
  CHECK(visited.revisit(1, 0.52, 2, 0.1));   // 0.08 away
  visited.start(3);
  CHECK(!visited.revisit(1, 0.52, 2, 0.1));
  visited.start(5);
  CHECK(!visited.revisit(4, 0.5, 2, 10));
  CHECK(visited.revisit(4, 0.9, 2, 10));
}

TEST_CASE("crossings: chords cross their triangle along the field") {
  for (const auto& soup : {jittered_grid(5, 4), test::sphere(2), test::moebius_strip(12, 3)}) {
    const auto mesh = soup.mesh();
    const auto field = test::random_field(mesh, 7);
    const auto sheet = make_sheet(mesh, field, 1.5);
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
      check_chords(mesh, field, t, sheet.crossings[sheet.ranks[t]]);
    }
  }
}

TEST_CASE("crossings: the split is the paper's critical coordinate") {
  // P0 opposite the edge P1 P2, v = alpha_1 x_1 + alpha_2 x_2: s_c = alpha_2 / (alpha_1 + alpha_2).
  const auto mesh = test::one_triangle().mesh();
  for (const double alpha : {0.1, 0.4, 0.77}) {
    const auto field = test::constant_field(mesh, Vector(1 - alpha, alpha, 0));
    const auto crossings = make_sheet(mesh, field, 1.5).crossings[0];
    const auto [from, to] = mesh.edges()[edge_of(mesh, 0, crossings, low_high)];
    CHECK((from == 1 && to == 2));  // seen along the field, P0 lies between the others
    const double along = crossings.is_reversed(low_high) ? 1 - crossings.split : crossings.split;
    CHECK(along == doctest::Approx(alpha).epsilon(1e-14));
    CHECK(crossings.longest_chord == doctest::Approx(std::hypot(1 - alpha, alpha)).epsilon(1e-7));
  }
}

TEST_CASE("crossings: exits lead back through the same side") {
  const auto mesh = test::klein_bottle(12, 8).mesh();
  const auto sheet = make_sheet(mesh, test::random_field(mesh, 2), 3.1);
  int joined = 0;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    for (const auto role : {low_high, low_middle, middle_high}) {
      const auto exit = sheet.crossings[t].exit(role);
      if (exit.triangle < 0) continue;
      const auto back = sheet.crossings[exit.triangle].exit(exit.role);
      CHECK((back.triangle == t && back.role == role));
      const auto edge = [&](std::int32_t i, Role side) {
        return edge_of(mesh, sheet.mesh_triangle(i), sheet.crossings[i], side);
      };
      CHECK(edge(t, role) == edge(exit.triangle, exit.role));
      ++joined;
    }
  }
  CHECK(joined > 0);
}

TEST_CASE("edge search: on a flat surface it finds exactly the edges that the capsule meets") {
  const auto mesh = jittered_grid(12, 9).mesh();
  const auto field = test::smooth_field(mesh);
  const StreamlineTracer tracer(mesh, field, {1});
  const auto workspace = StreamlineTracer::make_workspace();
  EdgeSearch search(mesh);
  Random random(3);
  for (int round = 0; round < 20; ++round) {
    const auto edge = static_cast<std::int32_t>(random.below(mesh.edges().size()));
    const auto line = tracer.trace(EdgePoint{edge, random.unit()}, nullptr, *workspace);
    const auto segment = random.below(line.triangles.size());
    const double radius = 0.01 + 3 * random.unit();
    const Capsule capsule{position(mesh, line.points[segment]), position(mesh, line.points[segment + 1]), radius};
    std::set<std::int32_t> found;
    for (const auto& [near, interval] : search.near_segment(line, segment, radius)) {
      CHECK(found.insert(near).second);
      CHECK((interval.low >= 0 && interval.low <= interval.high && interval.high <= 1));
    }
    for (std::int32_t e = 0; e < static_cast<std::int32_t>(mesh.edges().size()); ++e) {
      const Vector p = position(mesh, {e, 0}), q = position(mesh, {e, 1});
      CHECK(found.contains(e) == intersect(capsule, p, q - p).has_value());
    }
  }
}

TEST_CASE("seed ring: seeds lie at the distance from their line") {
  const auto mesh = jittered_grid(14, 11).mesh();
  const auto field = test::smooth_field(mesh);
  const double separation = 0.5;
  const StreamlineTracer tracer(mesh, field, {separation});
  const auto workspace = StreamlineTracer::make_workspace();
  for (const double factor : {1.1, 1.3, 5.8}) {
    const double distance = factor * separation;
    const auto occupancy = make_edge_mask(mesh, tracer);
    SeedRing ring(mesh, tracer, factor);
    Random random(1);
    CHECK(ring.draw(*occupancy, random) == std::nullopt);
    const auto line = tracer.trace(EdgePoint{mesh.triangle_edges()[150][0], 0.5}, nullptr, *workspace);
    ring.add(line);
    const auto at = test::places(mesh, line);
    std::set<std::int32_t> edges;
    for (int i = 0; i < 300; ++i) {
      const auto seed = ring.draw(*occupancy, random);
      REQUIRE(seed.has_value());
      CHECK(test::distance_to_polyline(position(mesh, seed->point), at) == doctest::Approx(distance).epsilon(1e-9));
      edges.insert(seed->point.edge);
    }
    CHECK(edges.size() > 20);
  }
}

TEST_CASE("seed ring: what the occupancy refuses is not drawn") {
  const auto mesh = jittered_grid(14, 11).mesh();
  const auto field = test::smooth_field(mesh);
  const StreamlineTracer tracer(mesh, field, {1});
  const auto workspace = StreamlineTracer::make_workspace();
  SeedRing ring(mesh, tracer, 1.3);
  ring.add(tracer.trace(EdgePoint{mesh.triangle_edges()[150][0], 0.5}, nullptr, *workspace));
  const test::RuledOccupancy left([&](const EdgePoint& point) { return position(mesh, point).x() < 7; });
  const test::RuledOccupancy full([](const EdgePoint&) { return false; });
  Random random(1);
  for (int i = 0; i < 200; ++i) CHECK(position(mesh, ring.draw(left, random).value().point).x() < 7);
  CHECK(ring.draw(full, random) == std::nullopt);
}

TEST_CASE("seed ring: it offers no seed where no streamline can start") {
  const auto mesh = jittered_grid(14, 11).mesh();
  const auto field = test::field_of(
      mesh, [](const Vector& c, const Vector&) { return c.x() > 7 ? Vector(0, 0, 0) : Vector(0.1, 1, 0); });
  const StreamlineTracer tracer(mesh, field, {0.5});
  const auto occupancy = make_edge_mask(mesh, tracer);
  const auto workspace = StreamlineTracer::make_workspace();
  SeedRing ring(mesh, tracer, 6);
  ring.add(tracer.trace(EdgePoint{mesh.triangle_edges()[12][1], 0.5}, nullptr, *workspace));
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const auto seed = ring.draw(*occupancy, random);
    REQUIRE(seed.has_value());
    CHECK(tracer.start_triangle(seed->point.edge) == seed->triangle);
  }
}

TEST_CASE("thread pool: each index once, always by the same thread") {
  for (const int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    CHECK(pool.thread_count() == threads);
    for (const std::int64_t count : {0, 1, 4, 1000}) {
      std::vector<int> worker(static_cast<std::size_t>(count), -1);
      std::atomic<int> calls = 0;
      pool.run(count, [&](std::int64_t index, int thread) {
        worker[static_cast<std::size_t>(index)] = thread;
        ++calls;
      });
      CHECK(calls == count);
      for (std::int64_t i = 0; i < count; ++i) CHECK(worker[static_cast<std::size_t>(i)] == i % threads);
    }
  }
}

TEST_CASE("thread pool: an exception comes through, once, and the pool goes on") {
  for (const int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    const ThreadPool::Work throw_everywhere = [](std::int64_t index, int) {
      throw std::runtime_error(std::to_string(index));
    };
    for (int round = 0; round < 3; ++round) {
      CHECK_THROWS_WITH_AS(pool.run(100, throw_everywhere), "0", std::runtime_error);
      std::atomic<int> calls = 0;
      pool.run(100, [&](std::int64_t, int) { ++calls; });
      CHECK(calls == 100);
    }
  }
}

TEST_CASE("thread pool: the calling thread is one of them") {
  ThreadPool pool(3);
  std::mutex mutex;
  std::set<std::thread::id> ids;
  pool.run(3, [&](std::int64_t, int) {
    const std::lock_guard lock(mutex);
    ids.insert(std::this_thread::get_id());
  });
  CHECK(ids.size() == 3);
  CHECK(ids.contains(std::this_thread::get_id()));
}

}  // namespace pectinate::detail
