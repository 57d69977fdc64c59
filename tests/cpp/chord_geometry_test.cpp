// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "detail/capsule.hpp"
#include "detail/chord_shadow.hpp"
#include "detail/closed_orbit.hpp"
#include "detail/interval_sets.hpp"
#include "detail/segment_distance.hpp"
#include "detail/self_free_run.hpp"
#include "placement_checks.hpp"

namespace pectinate::detail {
namespace {

using test::Soup;

Vector draw_vector(Random& random, double size = 1) {
  const double x = random.unit(), y = random.unit(), z = random.unit();
  return size * Vector(2 * x - 1, 2 * y - 1, 2 * z - 1);
}

// Distances between segments -----------------------------------------------------------------------------------------

/// By search: the distance to a segment is convex along another one.
double searched_distance(const Vector& p, const Vector& p_end, const Vector& q, const Vector& q_end) {
  double low = 0, high = 1;
  const auto distance = [&](double t) { return distance_to_segment(p + t * (p_end - p), q, q_end); };
  for (int i = 0; i < 200; ++i) {
    const double one = low + (high - low) / 3, other = high - (high - low) / 3;
    if (distance(one) <= distance(other)) {
      high = other;
    } else {
      low = one;
    }
  }
  return std::min({distance(0), distance(1), distance((low + high) / 2)});
}

void check_segment_distance(const Vector& p, const Vector& p_end, const Vector& q, const Vector& q_end) {
  const double found = segment_distance(p, p_end, q, q_end);
  const double size = 1 + (p_end - p).norm() + (q_end - q).norm() + (p - q).norm();
  CHECK(std::abs(found - searched_distance(p, p_end, q, q_end)) <= 2e-8 * size);
  CHECK(std::abs(found - segment_distance(q, q_end, p, p_end)) <= 1e-13 * size);
  CHECK(std::abs(found - segment_distance(p_end, p, q, q_end)) <= 1e-13 * size);
}

// Self-approach ------------------------------------------------------------------------------------------------------

SegmentRun longest_run(const std::vector<Vector>& points, std::span<const std::int32_t> starts,
                       std::int32_t before = 0) {
  return longest_self_free_run(starts, before, [&](std::size_t i) { return (points[i + 1] - points[i]).norm(); });
}

/// The length of the longest run by comparing all pairs; checks that a run found otherwise has it and is free.
void check_longest_run(const std::vector<Vector>& points, double distance, double arc_gap) {
  const auto count = points.size() - 1;
  std::vector<double> arc{0};
  for (std::size_t i = 0; i < count; ++i) arc.push_back(arc.back() + (points[i + 1] - points[i]).norm());
  const auto conflict = [&](std::size_t i, std::size_t j) {
    return arc[j] - arc[i + 1] > arc_gap &&
           segment_distance(points[i], points[i + 1], points[j], points[j + 1]) < distance;
  };
  // Without conflicts a run from `first` reaches up to `reached[first]`.
  double longest = 0;
  std::vector<std::size_t> reached(count, count);
  for (std::size_t first = count; first-- > 0;) {
    if (first + 1 < count) reached[first] = reached[first + 1];
    for (std::size_t j = first + 1; j < reached[first]; ++j) {
      if (conflict(first, j)) reached[first] = j;
    }
    longest = std::max(longest, arc[reached[first]] - arc[first]);
  }
  const auto starts = self_free_starts(points, distance, arc_gap);
  const auto run = longest_run(points, starts);
  REQUIRE(run.first < run.last);
  REQUIRE(run.last <= count);
  CHECK(run.last <= reached[run.first]);
  CHECK(arc[run.last] - arc[run.first] >= longest * (1 - 1e-12));
  // Of a part it is found from what is known of the whole.
  const auto before = static_cast<std::int32_t>(count / 4);
  const std::vector<Vector> part(points.begin() + before, points.end() - before / 2);
  const auto known = longest_run(part, std::span(starts).subspan(before, part.size() - 1), before);
  const auto alone = longest_run(part, self_free_starts(part, distance, arc_gap));
  CHECK(arc[known.last + before] - arc[known.first + before] ==
        doctest::Approx(arc[alone.last + before] - arc[alone.first + before]).epsilon(1e-12));
}

// Shadows ------------------------------------------------------------------------------------------------------------

/// A random triangle with a random direction in it.
struct RandomTriangle {
  explicit RandomTriangle(Random& random, double flatness = 1)
      : mesh(Soup{{vec3(draw_vector(random)), vec3(draw_vector(random)), vec3(draw_vector(random))}, {{0, 1, 2}}}
                 .mesh()),
        field(test::constant_field(mesh, draw_direction(mesh, random, flatness))),
        sheet(make_sheet(mesh, field, 1)) {}

  /// Close to parallel to a side if `flatness` is small.
  static Vector draw_direction(const SurfaceMesh& mesh, Random& random, double flatness) {
    const Vector side = test::corner(mesh, 0, 1) - test::corner(mesh, 0, 0);
    return side + flatness * draw_vector(random, 2);
  }

  Vector draw_point(Random& random) const {
    const Vector& a = test::corner(mesh, 0, 0);
    return a + random.unit() * (test::corner(mesh, 0, 1) - a) + random.unit() * (test::corner(mesh, 0, 2) - a);
  }

  SurfaceMesh mesh;
  OrientationField field;
  Sheet sheet;
};

/// One question in each lane, about triangles and capsules that differ: in which one it is asked must not matter.
struct FourQuestions {
  FourQuestions(const RandomTriangle& triangle, const Capsule& capsule, int lane, Random& random) {
    const auto& sheet = triangle.sheet;
    for (int other = 0; other < shadow_lanes; ++other) {
      const auto moved = [&](const Vector& place) -> Vector {
        return other == lane ? place : Vector(place + draw_vector(random, 0.1));
      };
      places[other] = {moved(sheet.low(0)), moved(sheet.middle(0)), moved(sheet.high(0)), moved(capsule.start),
                       moved(capsule.end)};
      const auto& [low, middle, high, start, end] = places[other];
      questions.low[other] = &low;
      questions.middle[other] = &middle;
      questions.high[other] = &high;
      questions.split[other] = other == lane ? sheet.crossings[0].split : 0.1 + 0.8 * random.unit();
      questions.start[other] = &start;
      questions.end[other] = &end;
      questions.radius[other] = other == lane ? capsule.radius : random.unit();
    }
  }
  std::array<std::array<Vector, 5>, shadow_lanes> places;
  ShadowQuestions questions;
};

bool holds(const ChordIntervals& chords, int lane, double chord) {
  return chords.low[lane] <= chord && chord <= chords.high[lane];
}

/// The shadow holds the chords that come within the radius of the axis, the core those all of which does, no more and
/// no less.
void check_shadow(const RandomTriangle& triangle, const Capsule& capsule, Random& random) {
  const double tolerance = 1e-8 * (1 + capsule.radius);
  const int lane = static_cast<int>(random.below(shadow_lanes));
  const FourQuestions four(triangle, capsule, lane, random);
  const auto [shadows, width] = chord_shadows(four.questions);
  const auto cores = chord_cores(four.questions);
  CHECK(width[lane] == doctest::Approx(triangle.sheet.crossings[0].width).epsilon(1e-6));
  if (shadows.low[lane] <= shadows.high[lane]) CHECK((shadows.low[lane] >= 0 && shadows.high[lane] <= 1));
  for (int i = 0; i <= 60; ++i) {
    const double chord = std::clamp(i / 60.0, 1e-6, 1 - 1e-6);
    const auto piece = test::chord_segment(triangle.sheet, 0, chord);
    const double distance = segment_distance(piece.start, piece.end, capsule.start, capsule.end);
    if (std::abs(distance - capsule.radius) >= tolerance) {
      CHECK(holds(shadows, lane, chord) == (distance < capsule.radius));
    }
    const double farthest = std::max(distance_to_segment(piece.start, capsule.start, capsule.end),
                                     distance_to_segment(piece.end, capsule.start, capsule.end));
    if (std::abs(farthest - capsule.radius) >= tolerance) {
      const bool is_in_core = holds(cores[0], lane, chord) || holds(cores[1], lane, chord);
      CHECK(is_in_core == (farthest < capsule.radius));
    }
  }
}

}  // namespace

TEST_CASE("segment distance: by search, whatever the order") {
  Random random(1);
  for (int round = 0; round < 2000; ++round) {
    check_segment_distance(draw_vector(random), draw_vector(random), draw_vector(random), draw_vector(random));
  }
}

TEST_CASE("segment distance: parallel, collinear, crossing, touching and point-like segments") {
  CHECK(segment_distance({0, 0, 0}, {1, 0, 0}, {0.2, 2, 0}, {0.7, 2, 0}) == 2);
  CHECK(segment_distance({0, 0, 0}, {1, 0, 0}, {4, 0, 0}, {2, 0, 0}) == 1);
  CHECK(segment_distance({0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {3, 0, 0}) == 0);
  CHECK(segment_distance({-1, 0, 0}, {1, 0, 0}, {0, -1, 0.5}, {0, 1, 0.5}) == 0.5);
  CHECK(segment_distance({-1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 7, 0}) == 0);
  CHECK(segment_distance({3, 4, 0}, {3, 4, 0}, {0, 0, 0}, {0, 0, 0}) == 5);
  CHECK(segment_distance({3, 4, 0}, {3, 4, 0}, {-9, 0, 0}, {9, 0, 0}) == 4);
  Random random(2);
  for (int round = 0; round < 500; ++round) {
    const Vector p = draw_vector(random), step = draw_vector(random), q = draw_vector(random);
    for (const double tilt : {0.0, 1e-15, 1e-12, 1e-9, 1e-6}) {
      const Vector almost = step + tilt * draw_vector(random);
      check_segment_distance(p, p + step, q, q + 0.7 * almost);
      check_segment_distance(p, p + step, p + 0.2 * step, p + 0.9 * almost);
      check_segment_distance(p, p + tilt * step, q, q + almost);
    }
  }
}

TEST_CASE("self-free run: as long as comparing all segments allows") {
  Random random(3);
  for (int round = 0; round < 60; ++round) {
    const double distance = 0.05 + 0.4 * random.unit();
    std::vector<Vector> points{draw_vector(random, 100)};
    for (int i = 0; i < 120; ++i) points.push_back(points.back() + draw_vector(random, round % 2 ? 0.1 : 0.4));
    for (const double gap : {0.0, 1.0, 2.0, 5.0}) check_longest_run(points, distance, gap * distance);
  }
}

TEST_CASE("self-free run: of spirals, circles, figures of eight and straight lines") {
  const auto curve = [](int count, const auto& at) {
    std::vector<Vector> points;
    for (int i = 0; i < count; ++i) points.push_back(at(static_cast<double>(i) / count));
    return points;
  };
  const auto eight = [](double t) -> Vector { return {std::sin(13 * t), std::sin(26 * t) / 2, 0}; };
  const auto circle = [](double t) -> Vector { return {std::cos(15 * t), std::sin(15 * t), 0.1 * t}; };
  const auto spiral = [](double t) -> Vector { return {t * std::cos(40 * t), t * std::sin(40 * t), 0}; };
  const auto straight = [](double t) -> Vector { return {9 * t, 0, -4 * t}; };
  for (const double distance : {0.02, 0.1, 0.15, 0.3, 1.0, 30.0}) {
    for (const auto& points : {curve(300, eight), curve(300, circle), curve(300, spiral), curve(9, circle)}) {
      check_longest_run(points, distance, 2 * distance);
    }
    const auto line = curve(50, straight);
    const auto run = longest_run(line, self_free_starts(line, distance, 2 * distance));
    CHECK((run.first == 0 && run.last == 49));
  }
}

TEST_CASE("self-free loop: as all pairs say, wherever the loop begins") {
  int free = 0, near = 0;
  for (const double waist : {0.05, 0.1, 0.2, 0.3, 0.5}) {
    for (const std::size_t count : {7, 30, 100}) {
      for (const std::size_t start : {std::size_t{0}, count / 3, count / 2}) {
        // An hourglass, so wide in the middle.
        std::vector<Vector> points;
        for (std::size_t i = 0; i <= count; ++i) {
          const double t = 2 * std::numbers::pi * static_cast<double>((i + start) % count) / static_cast<double>(count);
          points.emplace_back(std::cos(t), std::sin(t) * (waist / 2 + std::cos(t) * std::cos(t)),
                              0.1 * std::sin(3 * t));
        }
        std::vector<double> arc{0};
        for (std::size_t i = 0; i < count; ++i) arc.push_back(arc.back() + (points[i + 1] - points[i]).norm());
        for (const double distance : {0.04, 0.09, 0.19, 0.4, 2.0}) {
          bool expected = true;
          for (std::size_t j = 0; j < count; ++j) {
            for (std::size_t i = 0; i < j; ++i) {
              const double between = std::min(arc[j] - arc[i + 1], arc.back() - arc[j + 1] + arc[i]);
              if (between <= 2 * distance) continue;
              expected &= segment_distance(points[i], points[i + 1], points[j], points[j + 1]) >= distance;
            }
          }
          CHECK(is_self_free_loop(points, distance, 2 * distance) == expected);
          CHECK(keeps_from_itself(points, distance) == (expected && arc.back() >= 4 * distance));
          ++(expected ? free : near);
        }
      }
    }
  }
  CHECK(free > 50);
  CHECK(near > 25);
}

TEST_CASE("interval sets: they hold the union of what was added") {
  Random random(4);
  for (int round = 0; round < 30; ++round) {
    const std::size_t count = 4;
    IntervalSets sets(count);
    std::vector<std::vector<Interval>> added(count);
    for (int step = 0; step < 60; ++step) {
      const auto item = static_cast<std::int32_t>(random.below(count));
      // Multiples of 1/64 touch now and then; some reach beyond [0, 1].
      const double middle = static_cast<double>(random.below(65)) / 64;
      const double half = static_cast<double>(random.below(round % 3 == 0 ? 15 : 3)) / 64;
      sets.add(item, {middle - half, middle + half});
      added[item].push_back({middle - half, middle + half});

      const auto holds = [&](double x) {
        return std::any_of(added[item].begin(), added[item].end(),
                           [&](const auto& one) { return one.low <= x && x <= one.high; });
      };
      const auto intervals = sets.intervals(item), gaps = sets.gaps(item);
      bool all = true;
      for (int i = 0; i <= 128; ++i) {
        const double x = i / 128.0;
        CHECK(sets.contains(item, x) == holds(x));
        all = all && holds(x);
        const auto is_in = [&](const auto& one) { return one.low <= x && x <= one.high; };
        CHECK(std::any_of(intervals.begin(), intervals.end(), is_in) == holds(x));
        const auto is_open_in = [&](const auto& one) { return one.low < x && x < one.high; };
        if (i % 128 != 0) CHECK(std::any_of(gaps.begin(), gaps.end(), is_open_in) == !holds(x));
        const Interval ahead{x, x + 0.1};
        const bool expected = std::any_of(intervals.begin(), intervals.end(), [&](const auto& one) {
          return one.low <= ahead.low && ahead.high <= one.high;
        });
        CHECK((sets.contains(item, ahead) == expected || sets.is_full(item)));
      }
      CHECK(sets.is_full(item) == all);
      CHECK(!sets.is_empty(item));
      CHECK(gaps.empty() == all);
      for (std::size_t i = 0; i + 1 < intervals.size(); ++i) CHECK(intervals[i].high < intervals[i + 1].low);
      double measure = 0;
      for (const auto& one : intervals) measure += std::clamp(one.high, 0.0, 1.0) - std::clamp(one.low, 0.0, 1.0);
      for (const auto& one : gaps) measure += one.high - one.low;
      CHECK(measure == doctest::Approx(1).epsilon(1e-15));
    }
  }
}

TEST_CASE("interval sets: ends are rounded outwards, by less than 1e-9") {
  Random random(9);
  for (int round = 0; round < 2000; ++round) {
    IntervalSets sets(1);
    const double low = 1.2 * random.unit() - 0.1, high = low + std::exp(-25 * random.unit());
    sets.add(0, {low, high});
    if (high < 0 || low > 1) {
      CHECK(sets.is_empty(0));
      continue;
    }
    const auto intervals = sets.intervals(0);
    REQUIRE(intervals.size() == 1);
    CHECK((intervals[0].low <= std::max(low, 0.0) && intervals[0].low >= std::max(low, 0.0) - 1e-9));
    CHECK((intervals[0].high >= std::min(high, 1.0) && intervals[0].high <= std::min(high, 1.0) + 1e-9));
    for (const double x : {low, (low + high) / 2, high}) CHECK((x < 0 || x > 1 || sets.contains(0, x)));
  }
  IntervalSets sets(1);
  const double no_number = std::numeric_limits<double>::quiet_NaN();
  sets.add(0, {no_number, no_number});
  CHECK(sets.is_full(0));  // to be on the safe side
}

TEST_CASE("interval sets: filled is filled, whatever was there and comes") {
  IntervalSets sets(3);
  CHECK(sets.is_empty(1));
  CHECK(sets.gaps(1).size() == 1);
  CHECK(sets.intervals(1).empty());
  sets.add(1, {0.2, 0.3});
  sets.add(1, {0.6, 0.7});
  sets.fill(1);
  sets.add(1, {0.4, 0.5});
  CHECK(sets.is_full(1));
  CHECK(sets.contains(1, 0.35));
  CHECK(sets.gaps(1).empty());
  CHECK(sets.intervals(1).size() == 1);
  CHECK((sets.is_empty(0) && sets.is_empty(2)));
  // What was released is used again, by other items.
  sets.add(0, {0.1, 0.2});
  sets.add(2, {0.3, 0.4});
  CHECK((sets.contains(0, 0.15) && !sets.contains(0, 0.35) && sets.contains(2, 0.35) && !sets.contains(2, 0.15)));
}

TEST_CASE("chord shadow: the chords that enter a capsule, by definition") {
  Random random(5);
  for (int round = 0; round < 4000; ++round) {
    const RandomTriangle triangle(random);
    const double radius = std::exp(-5 * random.unit()) * 1.5;
    const Vector start = triangle.draw_point(random) + draw_vector(random, 1.2 * radius);
    check_shadow(triangle, {start, start + draw_vector(random, 2 * random.unit()), radius}, random);
  }
}

TEST_CASE("chord shadow: of capsules normal to the triangle, parallel to it, along its chords, and of balls") {
  Random random(6);
  for (int round = 0; round < 500; ++round) {
    const RandomTriangle triangle(random);
    const Vector normal = vector(triangle.mesh.triangle_normals()[0]);
    const Vector along = vector(triangle.field.directions()[0]), across = normal.cross(along);
    const double radius = 0.02 + random.unit();
    for (const double height : {0.0, 0.5, 0.9999, 1.0001}) {
      const Vector start = triangle.draw_point(random) + height * radius * normal;
      for (const double length : {0.0, 1e-14, 1e-7, 0.4, 5.0}) {
        for (const Vector& axis :
             {normal, along, across, Vector(along + 1e-9 * normal), Vector(-normal - 1e-8 * along)}) {
          check_shadow(triangle, {start, start + length * axis, radius}, random);
        }
      }
    }
  }
}

TEST_CASE("chord shadow: in triangles with a direction close to a side") {
  Random random(7);
  for (const double flatness : {1e-3, 1e-6, 1e-9, 0.0}) {
    for (int round = 0; round < 200; ++round) {
      const RandomTriangle triangle(random, flatness);
      const double radius = 0.02 + 0.5 * random.unit();
      const Vector start = triangle.draw_point(random) + draw_vector(random, radius);
      check_shadow(triangle, {start, start + draw_vector(random, 0.5), radius}, random);
    }
  }
}

}  // namespace pectinate::detail
