// SPDX-License-Identifier: MIT
#include "detail/covered_centres.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "detail/longest_first.hpp"
#include "lines.hpp"

namespace pectinate::test {
namespace {

using detail::Polyline;
using detail::Vector;

/// The lines of a placement.
std::vector<Polyline> placed_lines(const SurfaceMesh& mesh, const StreamlineTracer& tracer) {
  std::vector<Polyline> lines;
  detail::ChordOccupancy occupancy(mesh, tracer, {});
  const auto keep = [&](const detail::PlacedLine& placed) {
    lines.emplace_back().follow(tracer.sheet(), placed.chords, placed.is_closed);
  };
  detail::LineFiller(mesh, tracer, {0, false}, occupancy, keep).fill([] { return true; });
  return lines;
}

/// Of the triangles whose centres no line covers, from all distances.
double uncovered_area(const SurfaceMesh& mesh, const StreamlineTracer& tracer, const std::vector<Polyline>& lines,
                      const std::vector<bool>& is_out) {
  const auto& sheet = tracer.sheet();
  double area = 0;
  for (std::int32_t t = 0; t < sheet.triangle_count(); ++t) {
    const Vector centre = (sheet.low(t) + sheet.middle(t) + sheet.high(t)) / 3;
    bool is_covered = false;
    for (std::size_t i = 0; i < lines.size() && !is_covered; ++i) {
      for (std::size_t k = 0; k < lines[i].triangles.size() && !is_out[i]; ++k) {
        const double distance = detail::distance_to_segment(centre, lines[i].points[k], lines[i].points[k + 1]);
        is_covered |= distance <= tracer.separation_distance(sheet.mesh_triangle(lines[i].triangles[k]));
      }
    }
    if (!is_covered) area += mesh.triangle_areas()[sheet.mesh_triangle(t)];
  }
  return area;
}

}  // namespace

TEST_CASE("covered centres: they are what all distances say, whatever is taken back and put back") {
  const auto mesh = jittered_grid(16, 12).mesh();
  const auto field = smooth_field(mesh);
  for (const double separation : {0.3, 1.2}) {
    std::vector<double> separations(mesh.triangle_count(), separation);
    for (std::size_t t = 0; t < separations.size(); t += 3) separations[t] *= 1.2;
    const StreamlineTracer tracer(mesh, field, {separation, separations});
    const auto lines = placed_lines(mesh, tracer);
    std::vector<std::int32_t> all(mesh.triangle_count());
    std::iota(all.begin(), all.end(), 0);
    detail::CoveredCentres centres(mesh, tracer, 1);
    for (std::int32_t i = 0; i < std::ssize(lines); ++i) centres.add(i, lines[i], all);
    std::vector<bool> is_out(lines.size(), false);
    Random random(4);
    for (int round = 0; round < 10; ++round) {
      const double expected = uncovered_area(mesh, tracer, lines, is_out) - mesh.area();
      CHECK(centres.uncovered_area() == doctest::Approx(expected).epsilon(1e-12));
      std::vector<std::int32_t> taken, put;
      for (std::int32_t i = 0; i < std::ssize(lines); ++i) {
        if (random.unit() < 0.6) continue;
        (is_out[i] ? put : taken).push_back(i);
        is_out[i] = !is_out[i];
      }
      centres.take_back(taken);
      centres.put_back(put);
    }
  }
}

}  // namespace pectinate::test
