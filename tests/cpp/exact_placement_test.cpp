// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hard_fields.hpp"
#include "placement_checks.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;

constexpr auto all_methods = {PlacementMethod::random, PlacementMethod::neighborhood, PlacementMethod::distance,
                              PlacementMethod::longest};
constexpr auto longest = PlacementMethod::longest;

PlacementOptions with(double separation, PlacementMethod method = longest) {
  PlacementOptions options;
  options.separation_distance = separation;
  options.method = method;
  options.seed_count = 6;
  return options;
}

std::vector<double> separations_over(const SurfaceMesh& mesh, double least, double most) {
  std::vector<double> separations;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    separations.push_back(least + (most - least) * (0.5 + 0.5 * std::sin(centre(mesh, t).x())));
  }
  return separations;
}

}  // namespace

TEST_CASE("exact placement: whatever the field and the separation distance, it is even and complete") {
  const auto mesh = jittered_grid(12, 9).mesh();
  for (const auto& hard : hard_fields) {
    CAPTURE(hard.name);
    const auto field = make_field(mesh, hard);
    for (const double separation : {0.05, 0.31, 1.0, 4.0, 50.0}) {
      CAPTURE(separation);
      const auto placement = checked(mesh, field, with(separation));
      check_segment_separation(placement, separation);
      check_self_separation(placement, separation);
      check_complete(mesh, field, placement, 10);
      CHECK(placement.statistics.coverage > 1 - 1e-6);
    }
  }
}

TEST_CASE("exact placement: the paper's methods are even and complete too") {
  const auto mesh = jittered_grid(12, 9).mesh();
  for (const auto& hard : hard_fields) {
    CAPTURE(hard.name);
    const auto field = make_field(mesh, hard);
    for (const auto method : all_methods) {
      const auto placement = checked(mesh, field, with(0.6, method));
      check_segment_separation(placement, 0.6);
      check_complete(mesh, field, placement, 10);
    }
  }
}

TEST_CASE("exact placement: with a clearance for seeds lines stay d_sep apart and start in wider gaps only") {
  const auto mesh = jittered_grid(12, 9).mesh();
  for (const auto& hard : hard_fields) {
    CAPTURE(hard.name);
    const auto field = make_field(mesh, hard);
    for (const auto method : all_methods) {
      auto options = with(0.4, method);
      options.seed_clearance = 1.16;
      const auto placement = checked(mesh, field, options);
      check_segment_separation(placement, 0.4);
      check_complete(mesh, field, placement, 10);
      check_room_to_start(placement);
      if (method == longest) check_self_separation(placement, 0.4);
    }
  }
}

TEST_CASE("exact placement: with a clearance for seeds long lines need d_sep only") {
  // A strip so narrow that beside the first line there is d_sep, but nowhere the clearance.
  const auto mesh = jittered_grid(24, 3).mesh();
  const auto field = constant_field(mesh, Vector(1, 0, 0));
  auto options = with(1);
  options.seed_clearance = 1.9;
  const auto count_long = [&] {
    const auto lengths = place_streamlines(mesh, field, options).lengths;
    return std::ranges::count_if(lengths, [](double length) { return length >= 9; });
  };
  const auto with_long_ones = count_long();
  options.test_distance = 0.999;  // they would come nearer than d_sep
  CHECK(with_long_ones > count_long());
}

TEST_CASE("exact placement: a clearance for seeds gives longer and fewer lines") {
  const auto mesh = sphere(4, 4).mesh();
  const auto field = smooth_field(mesh);
  auto options = with(0.3);
  const auto strict = place_streamlines(mesh, field, options).statistics;
  options.seed_clearance = 1.16;
  const auto wider = place_streamlines(mesh, field, options).statistics;
  CHECK(wider.mean_length > strict.mean_length);
  CHECK(wider.streamline_count < strict.streamline_count);
  CHECK(wider.coverage > 0.98);
}

TEST_CASE("exact placement: with a test distance lines run on until they are that near") {
  const auto mesh = jittered_grid(12, 9).mesh();
  for (const auto& hard : hard_fields) {
    CAPTURE(hard.name);
    const auto field = make_field(mesh, hard);
    for (const auto method : all_methods) {
      auto options = with(0.4, method);
      options.test_distance = 0.8;
      const auto placement = checked(mesh, field, options);
      check_segment_separation(placement, 0.8 * 0.4);
      check_complete(mesh, field, placement, 10);
      check_room_to_start(placement);
    }
  }
}

TEST_CASE("exact placement: no line is shorter than asked") {
  const auto mesh = jittered_grid(12, 9).mesh();
  for (const auto& hard : hard_fields) {
    CAPTURE(hard.name);
    const auto field = make_field(mesh, hard);
    for (const auto method : all_methods) {
      for (const double minimum : {0.3, 2.0, 6.0}) {
        CAPTURE(minimum);
        auto options = with(0.4, method);
        options.minimum_length = minimum;
        options.seed_clearance = minimum > 1 ? 1 : 1.16;
        const auto placement = place_streamlines(mesh, field, options);
        CHECK(placement.end == PlacementEnd::complete);
        for (const double length : placement.lengths) CHECK(length >= minimum * (1 - 1e-6));
        check_segment_separation(placement, 0.4);
      }
    }
  }
}

TEST_CASE("exact placement: seeds that were too short do not stop others") {
  // Lines beside the border are cut off by nothing; so nothing may end at others but where others are.
  const auto mesh = jittered_grid(12, 9).mesh();
  const auto field = smooth_field(mesh);
  for (const auto method : all_methods) {
    auto options = with(0.4, method);
    options.minimum_length = 3;
    const auto placement = checked(mesh, field, options);
    const auto segments = segments_of(placement);
    const auto sheet = detail::make_sheet(mesh, field, options.abrupt_turn_angle);
    double covered = 0, area = 0;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
      for (int i = 0; i < 40; ++i) {
        const auto chord = chord_segment(sheet, t, (i + 0.5) / 40);
        const bool taken = std::any_of(segments.begin(), segments.end(), [&](const auto& segment) {
          return !chord.is_farther_than(segment, 0.4) && chord.distance(segment) < 0.4;
        });
        const double weight = chord.length() * sheet.crossings[sheet.ranks[t]].width;
        covered += taken ? weight : 0;
        area += weight;
      }
    }
    CHECK(std::abs(placement.statistics.coverage - covered / area) < 0.005);
  }
}

TEST_CASE("exact placement: the same separation distance everywhere gives the same bytes as one number") {
  const auto mesh = sphere(3, 4).mesh();
  const auto field = smooth_field(mesh);
  for (const auto occupancy : {OccupancyModel::exact, OccupancyModel::edge_mask}) {
    for (const auto method : all_methods) {
      if (method == longest && occupancy == OccupancyModel::edge_mask) continue;
      auto options = with(0.7, method);
      options.occupancy = occupancy;
      const auto expected = place_streamlines(mesh, field, options);
      options.separation_distances.assign(mesh.triangle_count(), 0.7);
      options.separation_distance = 123;
      const auto placement = place_streamlines(mesh, field, options);
      CHECK(same_bytes(placement, expected));
      CHECK(placement.statistics.mean_spacing_ratio ==
            doctest::Approx(expected.statistics.mean_spacing_ratio).epsilon(1e-12));
    }
  }
}

TEST_CASE("exact placement: where the separation distance varies, that of the line placed first counts") {
  const auto mesh = jittered_grid(16, 12).mesh();
  for (const std::uint64_t seed : {0, 1}) {
    const auto field = seed == 0 ? smooth_field(mesh) : random_field(mesh, seed);
    for (const auto method : all_methods) {
      for (const auto& [least, most] : {std::pair{0.3, 1.2}, {1.0, 5.0}}) {
        auto options = with(1, method);
        options.separation_distances = separations_over(mesh, least, most);
        const auto placement = checked(mesh, field, options);
        const auto segments = segments_of(placement);
        double nearest = std::numeric_limits<double>::infinity();
        for (const auto& later : segments) {
          for (const auto& earlier : segments) {
            if (earlier.line >= later.line) break;
            if (later.is_farther_than(earlier, 2 * earlier.separation_distance)) continue;
            nearest = std::min(nearest, later.distance(earlier) / earlier.separation_distance);
          }
        }
        CHECK(nearest >= 1);
        CHECK(placement.statistics.mean_spacing / placement.statistics.mean_spacing_ratio >= least);
        CHECK(placement.statistics.mean_spacing / placement.statistics.mean_spacing_ratio <= most);
      }
    }
  }
}

TEST_CASE("exact placement: more lines where the separation distance is less") {
  const auto mesh = jittered_grid(20, 10).mesh();
  auto options = with(1);
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    options.separation_distances.push_back(centre(mesh, t).x() < 10 ? 0.5 : 2);
  }
  const auto placement = checked(mesh, constant_field(mesh, Vector(0.02, 1, 0)), options);
  double left = 0, right = 0;
  for (const auto& piece : segments_of(placement)) (piece.start.x() < 10 ? left : right) += piece.length();
  CHECK(left > 2.5 * right);
}

TEST_CASE("exact placement: parallel lines lie as close as they may") {
  const auto spacing = [](const Soup& soup, const Vector& direction, double separation) {
    const auto mesh = soup.mesh();
    const auto placement = checked(mesh, constant_field(mesh, direction), with(separation));
    check_segment_separation(placement, separation);
    return placement.statistics.mean_spacing_ratio;
  };
  // Separation distances of which a whole number, and little more, fits across.
  for (const double separation : {40 / 28.05, 40 / 40.05, 40 / 90.05}) {
    CHECK(spacing(grid(60, 40), Vector(1, 0, 0), separation) <= 1.005);
    CHECK(spacing(jittered_grid(60, 40), Vector(1, 0, 0), separation) <= 1.005);
  }
  for (const double separation : {60 / 41.05, 60 / 100.05}) {
    CHECK(spacing(grid(60, 40), Vector(0, 1, 0), separation) <= 1.005);
    CHECK(spacing(jittered_grid(60, 40), Vector(0, 1, 0), separation) <= 1.005);
  }
}

TEST_CASE("exact placement: oblique parallel lines are d_sep apart and whole") {
  const auto mesh = jittered_grid(60, 40).mesh();
  for (const double angle : {0.4, 1.1, 2.3}) {
    const auto placement = checked(mesh, constant_field(mesh, Vector(std::cos(angle), std::sin(angle), 0)), with(1));
    CHECK(placement.statistics.mean_spacing_ratio < 1.02);  // of which a line short of a corner is a part
    CHECK(stop_count(placement, StopReason::boundary) == 2 * placement.statistics.streamline_count);
  }
}

TEST_CASE("exact placement: a line ends at others where they are d_sep away, in the midst of triangles") {
  const auto mesh = jittered_grid(12, 9).mesh();
  for (const auto& hard : hard_fields) {
    CAPTURE(hard.name);
    for (const double separation : {0.4, 1.7}) {
      check_ends_near_others(checked(mesh, make_field(mesh, hard), with(separation)));
    }
  }
}

TEST_CASE("exact placement: lines stop at borders, there alone, and say so") {
  const auto mesh = jittered_grid(12, 9).mesh();
  for (const auto& hard : hard_fields) {
    CAPTURE(hard.name);
    for (const double separation : {0.05, 0.4}) {  // with many candidates, which are dropped now and then, and with few
      const auto placement = checked(mesh, make_field(mesh, hard), with(separation));
      for (std::size_t i = 0; i < placement.lengths.size(); ++i) {
        for (const int end : {0, 1}) {
          const auto p = end == 0 ? placement.offsets[i] : placement.offsets[i + 1] - 1;
          const auto& weights = placement.barycentric[p];
          const auto opposite = static_cast<int>(std::find(weights.begin(), weights.end(), 0.0) - weights.begin());
          const bool is_border =
              opposite < 3 && mesh.neighbour(placement.point_triangles[p], (opposite + 1) % 3).triangle < 0;
          CHECK((placement.stop_reasons[i][end] == StopReason::boundary) == is_border);
        }
      }
    }
  }
}

TEST_CASE("exact placement: spirals keep from themselves, just so far, however many candidates are cut and dropped") {
  const auto mesh = jittered_grid(24, 18).mesh();
  int count = 0;
  for (const double inwards : {0.003, 0.02, 0.1}) {
    const auto field = field_of(mesh, [&](const Vector& c, const Vector&) {
      const Vector r = c - Vector(12.3, 9.2, 0);
      return Vector(-r.y() + inwards * r.x(), r.x() + inwards * r.y(), 0);
    });
    for (const double separation : {0.13, 0.6}) {
      const auto placement = checked(mesh, field, with(separation));
      check_segment_separation(placement, separation);
      check_self_separation(placement, separation);
      count += check_ends_near_themselves(placement);
    }
  }
  CHECK(count > 3);
}

TEST_CASE("exact placement: where candidates run on beside one another, most are dropped and no gap is left") {
  const auto mesh = jittered_grid(48, 36).mesh();
  const auto field = field_of(mesh, [](const Vector& c, const Vector&) {
    const Vector r = c - Vector(24.3, 18.2, 0);
    return Vector(-r.y() + 0.01 * r.x(), r.x() + 0.01 * r.y(), 0);
  });
  const auto placement = checked(mesh, field, with(0.1));
  CHECK(placement.statistics.coverage > 1 - 1e-6);
  check_segment_separation(placement, 0.1);
}

TEST_CASE("exact placement: where d_sep varies, a streamline keeps from itself what d_sep is where it was begun") {
  const auto mesh = jittered_grid(24, 18).mesh();
  const auto field = field_of(mesh, [&](const Vector& c, const Vector&) {
    const Vector r = c - Vector(12.3, 9.2, 0);
    return Vector(-r.y() + 0.02 * r.x(), r.x() + 0.02 * r.y(), 0);
  });
  auto options = with(1);
  options.separation_distances = separations_over(mesh, 0.3, 0.8);
  const auto placement = checked(mesh, field, options);
  const auto placed = as_placed(placement);
  const auto segments = segments_of(placement);
  int count = 0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const auto line = segments[i].line;
    const auto first = placed.offsets[line] - static_cast<std::int64_t>(line);
    const double separation = options.separation_distances[placed.segment_triangles[first]];
    for (std::size_t j = i; j-- > 0 && segments[j].line == line;) {
      if (segments[i].arc - segments[j].arc_end <= 2 * separation * (1 + 1e-9)) continue;
      if (segments[i].is_farther_than(segments[j], 2 * separation)) continue;
      CHECK(segments[i].distance(segments[j]) >= separation * (1 - 1e-9));
      ++count;
    }
  }
  CHECK(count > 100);
}

TEST_CASE("exact placement: around what is smaller than d_sep no streamline comes to a triangle twice") {
  const auto mesh = jittered_grid(12, 9).mesh();
  for (const auto& hard : hard_fields) {
    CAPTURE(hard.name);
    const auto placement = checked(mesh, make_field(mesh, hard), with(50));  // criterion 5 alone would allow it
    for (std::size_t i = 0; i < placement.lengths.size(); ++i) {
      const auto line = static_cast<std::ptrdiff_t>(i);
      std::vector<std::int32_t> crossed(placement.segment_triangles.begin() + placement.offsets[i] - line,
                                        placement.segment_triangles.begin() + placement.offsets[i + 1] - line - 1);
      std::ranges::sort(crossed);
      CHECK(std::ranges::adjacent_find(crossed) == crossed.end());
    }
  }
}

}  // namespace pectinate::test
