// SPDX-License-Identifier: MIT
#include "pectinate/tracing.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <limits>
#include <set>

#include "lines.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;
using detail::vector;
using std::numbers::pi;

/// Traces on one surface, checking every streamline.
class Bench {
 public:
  Bench(const Soup& soup, const std::function<OrientationField(const SurfaceMesh&)>& make_field,
        const TracingOptions& options)
      : mesh(soup.mesh()), field(make_field(mesh)), tracer(mesh, field, options) {}

  Streamline trace(const EdgePoint& seed, const Occupancy* occupancy = nullptr) const {
    const auto workspace = StreamlineTracer::make_workspace();
    const Streamline line = tracer.trace(seed, occupancy, *workspace);
    check_streamline(mesh, field, line);
    CHECK(line.points[line.seed_index].edge == seed.edge);
    CHECK(std::abs(line.points[line.seed_index].position - seed.position) <= 1e-9);
    return line;
  }

  EdgePoint random_seed(Random& random) const {
    return {static_cast<std::int32_t>(random.below(mesh.edges().size())), random.unit()};
  }

  /// The edge between two input vertices.
  std::int32_t edge(std::int32_t a, std::int32_t b) const {
    for (std::int32_t e = 0; e < static_cast<std::int32_t>(mesh.edges().size()); ++e) {
      const auto [p, q] = mesh.edges()[e];
      const std::set<std::int32_t> ends{mesh.input_vertex()[p], mesh.input_vertex()[q]};
      if (ends == std::set{a, b}) return e;
    }
    FAIL("no such edge");
    return -1;
  }

  SurfaceMesh mesh;
  OrientationField field;
  StreamlineTracer tracer;
};

auto constant(const Vector& direction) {
  return [=](const SurfaceMesh& mesh) { return constant_field(mesh, direction); };
}

Vector at_angle(double angle) {
  return {std::cos(angle), std::sin(angle), 0};
}

/// Two triangles on either side of the edge from vertex 0 to vertex 1 along y, the second one folded up by an angle.
Soup folded_pair(double fold) {
  return {{{0, 0, 0}, {0, 1, 0}, {-1, 0.5, 0}, {std::cos(fold), 0.5, std::sin(fold)}}, {{0, 1, 2}, {0, 3, 1}}};
}

/// On a folded pair: `before` and `after` are the angles to the x axis when the second triangle is unfolded.
auto turning(double fold, double before, double after) {
  return [=](const SurfaceMesh& mesh) {
    const Vector across(std::cos(fold), 0, std::sin(fold)), along(0, 1, 0);
    return OrientationField::from_triangle_vectors(
        mesh, std::vector<Vec3>{detail::vec3(at_angle(before)),
                                detail::vec3(std::cos(after) * across + std::sin(after) * along)});
  };
}

/// How far the line through `place` runs inside [0, width] x [0, height].
double clipped_length(const Vector& place, const Vector& direction, double width, double height) {
  double from = -std::numeric_limits<double>::infinity(), to = -from;
  const double sizes[] = {width, height};
  for (int axis = 0; axis < 2; ++axis) {
    const double a = -place[axis] / direction[axis], b = (sizes[axis] - place[axis]) / direction[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return to - from;
}

/// Criterion 5, by its definition, among all points.
void check_apart_from_itself(const std::vector<Vector>& at, double separation) {
  std::vector<double> arc{0};
  for (std::size_t i = 1; i < at.size(); ++i) arc.push_back(arc.back() + (at[i] - at[i - 1]).norm());
  for (std::size_t i = 0; i < at.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (arc[i] - arc[j] > 2 * separation * (1 + 1e-9)) CHECK((at[i] - at[j]).norm() >= separation * (1 - 1e-9));
    }
  }
}

auto vortex_around(const Vector& axis_point) {
  return [=](const SurfaceMesh& mesh) {
    return field_of(mesh, [&](const Vector& c, const Vector& n) { return Vector(n.cross(c - axis_point)); });
  };
}

}  // namespace

TEST_CASE("tracing: a constant field on a flat surface gives the whole straight line") {
  for (const double angle : {0.3, 1.2, 2.0, 2.9}) {
    const Bench bench(jittered_grid(12, 9), constant(at_angle(angle)), {0.5});
    Random random(1);
    for (int round = 0; round < 60; ++round) {
      const auto line = bench.trace(bench.random_seed(random));
      const Vector place = detail::position(bench.mesh, line.points[line.seed_index]);
      CHECK(std::abs(line.length - clipped_length(place, at_angle(angle), 12, 9)) < 1e-7);
      for (const auto& p : places(bench.mesh, line)) CHECK((p - place).cross(at_angle(angle)).norm() < 1e-7);
      for (const auto reason : line.stop_reasons) CHECK(reason == StopReason::boundary);
    }
  }
}

TEST_CASE("tracing: away from vertices a straight line is straight to rounding") {
  const Bench bench(grid(8, 8), constant(Vector(1, -1, 0)), {0.5});
  // Across the diagonals of unit squares: the line x + y = 8.5 crosses each edge a quarter from its ends or farther.
  const auto line = bench.trace({bench.edge(8, 17), 0.5});
  CHECK(std::abs(line.length - 7.5 * std::numbers::sqrt2) < 1e-13);
  for (const auto& p : places(bench.mesh, line)) CHECK(std::abs(p.x() + p.y() - 8.5) < 1e-14);
}

TEST_CASE("tracing: what is true of every streamline is true on any surface in any field") {
  Random random(11);
  for (const auto& soup : {jittered_grid(9, 7), sphere(3), torus(20, 12), moebius_strip(30, 5), klein_bottle(24, 16),
                           three_on_an_edge(), one_triangle()}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      const Bench bench(
          soup, [=](const SurfaceMesh& mesh) { return seed == 1 ? smooth_field(mesh) : random_field(mesh, seed); },
          {.separation_distance = 0.2, .abrupt_turn_angle = seed == 3 ? pi : pi / 2});
      for (int round = 0; round < 40; ++round) {
        check_apart_from_itself(places(bench.mesh, bench.trace(bench.random_seed(random))), 0.2);
      }
    }
  }
}

TEST_CASE("tracing: a streamline is the same from each of its points") {
  for (const auto& soup : {jittered_grid(12, 9), sphere(3), moebius_strip(40, 5)}) {
    const Bench bench(soup, smooth_field, {1e-3});
    Random random(2);
    int compared = 0;
    for (int round = 0; round < 20; ++round) {
      const auto line = bench.trace(bench.random_seed(random));
      // Where a line comes near itself, how far it goes depends on the seed.
      if (std::count(line.stop_reasons.begin(), line.stop_reasons.end(), StopReason::near_itself)) continue;
      ++compared;
      // At an end there may be another line on the other side of the edge.
      for (std::size_t i = 1; i + 1 < line.points.size(); i += 5) {
        auto again = bench.trace(line.points[i]);
        REQUIRE(again.points.size() == line.points.size());
        if (again.triangles != line.triangles) {
          std::reverse(again.points.begin(), again.points.end());
          std::swap(again.stop_reasons[0], again.stop_reasons[1]);
        }
        for (std::size_t p = 0; p < line.points.size(); ++p) {
          CHECK(again.points[p].edge == line.points[p].edge);
          CHECK(std::abs(again.points[p].position - line.points[p].position) < 1e-6);
        }
        CHECK(again.stop_reasons == line.stop_reasons);
      }
    }
    CHECK(compared >= 5);
  }
}

TEST_CASE("tracing: a helix climbs a prism at its angle") {
  const double slope = 0.37;
  const Bench bench(cylinder(24, 17, 1, 3),
                    [=](const SurfaceMesh& mesh) {
                      return field_of(mesh, [=](const Vector&, const Vector& n) {
                        return Vector(std::cos(slope) * Vector(0, 0, 1).cross(n) + std::sin(slope) * Vector(0, 0, 1));
                      });
                    },
                    {0.1});
  for (const std::int32_t edge : {0, 77, 400}) {
    const auto line = bench.trace({edge, 0.4});
    CHECK(std::abs(line.length - 3 / std::sin(slope)) < 1e-9);
    for (const auto reason : line.stop_reasons) CHECK(reason == StopReason::boundary);
  }
}

TEST_CASE("tracing: a closed circle ends where it would meet itself") {
  const double separation = 0.2;
  const Bench bench(cylinder(24, 17, 1, 3), vortex_around(Vector(0, 0, 0)), {separation});
  const auto around = [](const SurfaceMesh& mesh) {
    return field_of(mesh, [](const Vector&, const Vector& n) { return Vector(Vector(0, 0, 1).cross(n)); });
  };
  const Bench circles(cylinder(24, 17, 1, 3), around, {separation});
  const double circumference = 24 * 2 * std::sin(pi / 24), longest_edge = 2 * std::sin(pi / 24);
  const auto line = circles.trace({circles.edge(24 * 5, 24 * 6), 0.3});
  CHECK(line.length < circumference - separation + 1e-9);
  CHECK(line.length > circumference - separation - longest_edge);
  for (const auto reason : line.stop_reasons) CHECK(reason == StopReason::near_itself);
}

TEST_CASE("tracing: around a Moebius strip a line comes back on the other side of the middle") {
  const int around = 60, rows = 8;
  // Along the rows of the strip: with a small separation distance the line closes after two laps only.
  const auto along = [=](const SurfaceMesh& mesh) {
    std::vector<Vec3> vectors;
    for (const auto& [a, b, c] : moebius_strip(around, rows).triangles) {
      const auto& v = mesh.vertices();
      const bool lower = vectors.size() % 2 == 0;  // a, b, c and a, c, d of a square
      vectors.push_back(detail::vec3(lower ? vector(v[b]) - vector(v[a]) : vector(v[b]) - vector(v[c])));
    }
    return OrientationField::from_triangle_vectors(mesh, vectors);
  };
  const Bench bench(moebius_strip(around, rows), along, {0.1});
  const double lap = 4 * pi;
  const auto outer = bench.trace({bench.edge(0, 1), 0.5});  // 0.44 from the middle
  CHECK(outer.length > 2 * lap - 0.7);
  CHECK(outer.length < 2 * lap);
  const auto middle = bench.trace({bench.edge(rows / 2, rows / 2 + 1), 0.01});  // 0.001 from the middle
  CHECK(middle.length > lap - 0.7);
  CHECK(middle.length < lap);
  for (const auto reason : {outer.stop_reasons[0], outer.stop_reasons[1], middle.stop_reasons[0]}) {
    CHECK(reason == StopReason::near_itself);
  }
}

TEST_CASE("tracing: it stops at turns above the threshold only, measured on the unfolded surface") {
  for (const double fold : {0.0, 0.8, -1.9}) {
    for (const auto& [before, after] : {std::pair{0.2, 0.7}, {-0.3, 0.3}, {-0.7, 0.7}, {0.1, -1.1}}) {
      const double turn = std::abs(after - before);
      for (const double threshold : {turn - 1e-9, turn + 1e-9}) {
        const Bench bench(folded_pair(fold), turning(fold, before, after),
                          {.separation_distance = 0.01, .abrupt_turn_angle = threshold});
        const auto line = bench.trace({bench.edge(0, 1), 0.5});
        CHECK((line.triangles.size() == 2) == (threshold > turn));
        CHECK(line.stop_reasons[0] == (threshold > turn ? StopReason::boundary : StopReason::abrupt_turn));
        CHECK(line.stop_reasons[1] == StopReason::boundary);
      }
    }
  }
}

TEST_CASE("tracing: a U-turn is abrupt, though the lines are almost parallel") {
  // Lines at +80 and -80 degrees to the edge's normal make an angle of 20 degrees, but no one can follow both.
  const double steep = 80 * pi / 180;
  const Bench bench(folded_pair(0), turning(0, steep, -steep), {0.01});
  CHECK(bench.trace({bench.edge(0, 1), 0.5}).stop_reasons[0] == StopReason::abrupt_turn);
  const Bench parallel(folded_pair(0), turning(0, steep, steep), {0.01});
  CHECK(parallel.trace({parallel.edge(0, 1), 0.5}).triangles.size() == 2);
}

TEST_CASE("tracing: it stops where the field ends") {
  const auto hole = [](const SurfaceMesh& mesh) {
    return field_of(mesh,
                    [](const Vector& c, const Vector&) { return c.x() > 4 ? Vector(0, 0, 0) : Vector(1, 0.1, 0); });
  };
  const Bench bench(grid(6, 2), hole, {0.1});
  const auto line = bench.trace({bench.edge(1, 8), 0.5});
  const auto at = places(bench.mesh, line);
  const bool first_is_left = at.front().x() < at.back().x();
  CHECK(std::min(at.front().x(), at.back().x()) == doctest::Approx(0));
  CHECK(std::max(at.front().x(), at.back().x()) >= 3.99);
  CHECK(line.stop_reasons[first_is_left ? 0 : 1] == StopReason::boundary);
  CHECK(line.stop_reasons[first_is_left ? 1 : 0] == StopReason::no_field);
  for (const auto t : line.triangles) CHECK(bench.field.has_direction(t));
}

TEST_CASE("tracing: max_steps counts the triangles each way") {
  for (const std::int64_t max_steps : {1, 2, 7}) {
    const Bench bench(jittered_grid(40, 4), constant(at_angle(0.01)),
                      {.separation_distance = 0.1, .max_steps = max_steps});
    const auto line = bench.trace({bench.edge(20 + 41 * 2, 20 + 41 * 3), 0.5});
    CHECK(static_cast<std::int64_t>(line.triangles.size()) == 2 * max_steps);
    CHECK(line.seed_index == max_steps);
    for (const auto reason : line.stop_reasons) CHECK(reason == StopReason::max_steps);
  }
}

TEST_CASE("tracing: it stops before the first point that the occupancy refuses") {
  const Bench bench(jittered_grid(20, 6), constant(at_angle(0.2)), {0.1});
  const EdgePoint seed{bench.edge(10 + 21 * 3, 10 + 21 * 4), 0.5};
  const auto free = bench.trace(seed);
  for (std::size_t refused = 0; refused < free.points.size(); refused += 3) {
    const auto edge = free.points[refused].edge;
    const RuledOccupancy occupancy([=](const EdgePoint& point) { return point.edge != edge; });
    const auto line = bench.trace(seed, &occupancy);
    const auto index = static_cast<std::int64_t>(refused);
    if (index == free.seed_index) continue;
    const bool before_seed = index < free.seed_index;
    CHECK(line.stop_reasons[before_seed ? 0 : 1] == StopReason::near_other);
    CHECK(static_cast<std::int64_t>(line.triangles.size()) ==
          (before_seed ? static_cast<std::int64_t>(free.triangles.size()) - index - 1 : index - 1));
  }
}

TEST_CASE("tracing: where nothing is admitted there is no segment") {
  const Bench bench(jittered_grid(4, 4), constant(at_angle(0.2)), {0.1});
  const RuledOccupancy full([](const EdgePoint&) { return false; });
  const auto line = bench.trace({bench.edge(6, 11), 0.5}, &full);
  CHECK(line.points.size() == 1);
  CHECK(line.length == 0);
}

TEST_CASE("tracing: it goes on past vertices, however close the seed") {
  const Bench bench(grid(8, 6), constant(Vector(1, 0.5, 0)), {0.1});
  for (const double position : {0.0, 1e-300, 1e-12, 1 - 1e-12, 1.0, -3.0, 4.0}) {
    const auto workspace = StreamlineTracer::make_workspace();
    const auto line = bench.tracer.trace(EdgePoint{bench.edge(3 + 9 * 2, 3 + 9 * 3), position}, nullptr, *workspace);
    check_streamline(bench.mesh, bench.field, line);
    const Vector place = detail::position(bench.mesh, line.points[line.seed_index]);
    CHECK(std::abs(line.length - clipped_length(place, Vector(2, 1, 0).normalized(), 8, 6)) < 1e-6);
  }
}

TEST_CASE("tracing: a field along the edges runs beside them to the border") {
  for (const Vector& direction : {Vector(1, 0, 0), Vector(0, 1, 0), Vector(1, 1, 0)}) {
    const Bench bench(grid(8, 8), constant(direction), {0.1});
    for (const auto& [a, b] : {std::pair{40, 41}, {40, 49}, {40, 50}}) {  // around the middle: all three kinds of edge
      for (const double position : {0.0, 0.5, 1.0}) {
        const auto line = bench.trace({bench.edge(a, b), position});
        const auto at = places(bench.mesh, line);
        const Vector seed = at[line.seed_index];
        for (const auto& p : at) CHECK((p - seed).cross(direction.normalized()).norm() < 1e-5);
        for (const auto reason : line.stop_reasons) CHECK(reason == StopReason::boundary);
        CHECK(std::abs(line.length -
                       clipped_length(seed, direction + Vector(1e-12, 1e-12, 0), 8, 8) * direction.norm()) < 1e-4);
      }
    }
  }
}

TEST_CASE("tracing: a vortex ends soon, near and far from its centre") {
  const int n = 30;
  const Bench bench(jittered_grid(n, n), vortex_around(Vector(15.2, 14.9, 0)), {1.5});
  Random random(3);
  for (int round = 0; round < 200; ++round) {
    const auto line = bench.trace(bench.random_seed(random));
    CHECK(line.triangles.size() < 2 * bench.mesh.triangle_count());
    for (const auto reason : line.stop_reasons) CHECK(reason != StopReason::max_steps);
  }
  // Closer to the centre than criterion 5 can tell: about one lap.
  const auto inner = bench.trace({bench.edge(15 + 31 * 15, 16 + 31 * 15), 0.4});
  CHECK(inner.triangles.size() <= 40);
}

TEST_CASE("tracing: a fan around a vertex ends after a lap") {
  Soup fan{{{0, 0, 0}}, {}};
  const int count = 11;
  for (int i = 0; i < count; ++i) {
    fan.vertices.push_back({std::cos(turn(i, count)), std::sin(turn(i, count)), 0});
    fan.triangles.push_back({0, 1 + i, 1 + (i + 1) % count});
  }
  for (const double separation : {1e-3, 0.1, 5.0}) {
    const Bench bench(fan, vortex_around(Vector(0, 0, 0)), {separation});
    for (const double position : {1e-9, 1e-3, 0.4, 0.6}) {
      CHECK(bench.trace({bench.edge(0, 3), position}).triangles.size() <= 2 * count + 1);
    }
  }
}

TEST_CASE("tracing: it ends at a cut") {
  const Bench bench(three_on_an_edge(),
                    [](const SurfaceMesh& mesh) {
                      return field_of(mesh, [](const Vector& c, const Vector&) { return Vector(c.x(), c.y(), 0); });
                    },
                    {0.1});
  const auto line = bench.trace({bench.edge(0, 1), 0.5});
  CHECK(line.triangles.size() == 1);
  for (const auto reason : line.stop_reasons) CHECK(reason == StopReason::boundary);
}

TEST_CASE("tracing: a workspace forgets what was traced before") {
  const Bench bench(sphere(3), smooth_field, {0.1});
  const Bench other(jittered_grid(5, 4), smooth_field, {0.3});
  const auto used = StreamlineTracer::make_workspace();
  Random random(5);
  for (int round = 0; round < 50; ++round) {
    const auto& on = round % 3 == 0 ? other : bench;
    const auto seed = on.random_seed(random);
    const auto fresh = on.trace(seed);
    const auto& line = on.tracer.trace(seed, nullptr, *used);
    CHECK(line.triangles == fresh.triangles);
    CHECK(line.length == fresh.length);
    CHECK(line.stop_reasons == fresh.stop_reasons);
  }
}

TEST_CASE("tracing: scale, place and attitude do not matter") {
  const Eigen::Matrix3d rotation = some_rotation();
  const auto soup = jittered_grid(9, 7);
  const auto vectors =
      triangle_vectors(soup.mesh(), [](const Vector& c, const Vector&) { return Vector(1, std::sin(0.4 * c.x()), 0); });
  const auto make = [&](const Eigen::Matrix3d& turn) {
    return [&, turn](const SurfaceMesh& mesh) {
      auto all = vectors;
      for (auto& v : all) v = detail::vec3(turn * vector(v));
      return OrientationField::from_triangle_vectors(mesh, all);
    };
  };
  const Bench bench(soup, make(Eigen::Matrix3d::Identity()), {0.2});
  for (const double scale : {1e-3, 1.0, 1e3}) {
    const auto moved_soup =
        mapped(soup, [&](const Vector& v) { return Vector(scale * (rotation * v + Vector(40, -70, 9))); });
    const Bench turned(moved_soup, make(rotation), {0.2 * scale});
    Random random(6);
    for (int round = 0; round < 40; ++round) {
      const auto seed = bench.random_seed(random);
      const auto line = bench.trace(seed), other = turned.trace(seed);
      REQUIRE(line.triangles == other.triangles);
      CHECK(std::abs(line.length * scale / other.length - 1) < 1e-10);
      CHECK(line.stop_reasons == other.stop_reasons);
    }
  }
}

TEST_CASE("tracing: options out of range and another mesh's field are refused") {
  const auto mesh = grid(3, 3).mesh();
  const auto field = constant_field(mesh, Vector(1, 0.2, 0));
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const auto refused = [&](const TracingOptions& options) {
    CHECK_THROWS_AS(StreamlineTracer(mesh, field, options), InvalidOption);
  };
  for (const double separation : {0.0, -1.0, nan, infinity, 1e-9}) refused({separation});
  for (const double angle : {0.0, -1.0, 3.2, nan}) refused({.separation_distance = 1, .abrupt_turn_angle = angle});
  for (const std::int64_t steps : {0, -5}) refused({.separation_distance = 1, .max_steps = steps});
  const auto small = grid(1, 1).mesh();
  CHECK_THROWS_AS(StreamlineTracer(small, field, {1}), InvalidField);
}

TEST_CASE("tracing: where nothing can start it says so") {
  const auto mesh = together(one_triangle(), moved(one_triangle(), {3, 0, 0})).mesh();
  const auto field = OrientationField::from_triangle_vectors(mesh, std::vector<Vec3>{{1, 1, 0}, {0, 0, 0}});
  const StreamlineTracer tracer(mesh, field, {0.1});
  const auto workspace = StreamlineTracer::make_workspace();
  const auto without = mesh.triangle_edges()[1][0];
  CHECK(tracer.start_triangle(mesh.triangle_edges()[0][0]) == 0);
  CHECK(tracer.start_triangle(without) == std::nullopt);
  CHECK_THROWS_AS(tracer.trace(EdgePoint{without, 0.5}, nullptr, *workspace), InvalidField);
}

}  // namespace pectinate::test
