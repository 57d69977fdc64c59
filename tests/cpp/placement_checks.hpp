// SPDX-License-Identifier: MIT
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "lines.hpp"
#include "pectinate/placement.hpp"

/// What is true of every placement.
namespace pectinate::test {

inline std::vector<std::vector<detail::Vector>> polylines(const Placement& placement) {
  std::vector<std::vector<detail::Vector>> lines(placement.lengths.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (auto p = placement.offsets[i]; p < placement.offsets[i + 1]; ++p) {
      lines[i].push_back(detail::vector(placement.points[p]));
    }
  }
  return lines;
}

inline bool same_bytes(const Placement& a, const Placement& b) {
  return a.points == b.points && a.offsets == b.offsets && a.segment_triangles == b.segment_triangles &&
         a.point_triangles == b.point_triangles && a.barycentric == b.barycentric && a.lengths == b.lengths &&
         a.stop_reasons == b.stop_reasons && a.seed_points == b.seed_points &&
         a.statistics.coverage == b.statistics.coverage;
}

inline void check_points(const SurfaceMesh& mesh, const Placement& placement) {
  for (std::size_t p = 0; p < placement.points.size(); ++p) {
    const auto t = placement.point_triangles[p];
    const auto& weights = placement.barycentric[p];
    CHECK(weights[0] + weights[1] + weights[2] == doctest::Approx(1).epsilon(1e-15));
    CHECK(*std::min_element(weights.begin(), weights.end()) == 0);  // on a side
    CHECK(std::count(weights.begin(), weights.end(), 0.0) == 1);    // on no vertex
    const detail::Vector place =
        weights[0] * corner(mesh, t, 0) + weights[1] * corner(mesh, t, 1) + weights[2] * corner(mesh, t, 2);
    CHECK((place - detail::vector(placement.points[p])).norm() <= 1e-14 * (1 + place.norm()));
  }
}

/// The arrays fit together, and every segment lies in its triangle along the field.
inline void check_lines(const SurfaceMesh& mesh, const OrientationField& field, const Placement& placement) {
  const auto count = static_cast<std::int64_t>(placement.lengths.size());
  REQUIRE(static_cast<std::int64_t>(placement.offsets.size()) == count + 1);
  CHECK(placement.offsets.front() == 0);
  CHECK(placement.offsets.back() == static_cast<std::int64_t>(placement.points.size()));
  CHECK(static_cast<std::int64_t>(placement.segment_triangles.size()) == placement.offsets.back() - count);
  for (std::int64_t i = 0; i < count; ++i) {
    const auto first = placement.offsets[i], last = placement.offsets[i + 1] - 1;
    REQUIRE(last > first);
    CHECK((first <= placement.seed_points[i] && placement.seed_points[i] <= last));
    double length = 0;
    for (auto p = first; p < last; ++p) {
      const auto t = placement.segment_triangles[p - i];
      const detail::Vector step = detail::vector(placement.points[p + 1]) - detail::vector(placement.points[p]);
      CHECK(step.cross(detail::vector(field.directions()[t])).norm() <= 2e-7 * step.norm() + 1e-8);
      CHECK(std::abs(step.dot(detail::vector(mesh.triangle_normals()[t]))) <= 1e-13);
      CHECK(placement.point_triangles[p] == t);
      length += step.norm();
    }
    CHECK(placement.point_triangles[last] == placement.segment_triangles[last - 1 - i]);
    CHECK(placement.lengths[i] == doctest::Approx(length).epsilon(1e-6));
  }
}

inline void check_statistics(const SurfaceMesh& mesh, const OrientationField& field, const Placement& placement) {
  const auto& statistics = placement.statistics;
  const auto count = static_cast<std::int64_t>(placement.lengths.size());
  double area = 0;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    if (field.has_direction(t)) area += mesh.triangle_areas()[t];
  }
  CHECK(statistics.surface_area == doctest::Approx(area).epsilon(1e-12));
  CHECK(statistics.streamline_count == count);
  CHECK(std::accumulate(statistics.stop_counts.begin(), statistics.stop_counts.end(), std::int64_t{0}) == 2 * count);
  CHECK((statistics.coverage > 0 && statistics.coverage <= 1));
}

inline Placement checked(const SurfaceMesh& mesh, const OrientationField& field, const PlacementOptions& options) {
  auto placement = place_streamlines(mesh, field, options);
  CHECK(!placement.lengths.empty());
  check_lines(mesh, field, placement);
  check_points(mesh, placement);
  check_statistics(mesh, field, placement);
  CHECK(placement.end == PlacementEnd::complete);
  return placement;
}

/// Every point of a line was at least d_sep from all lines placed before it.
inline void check_separation(const Placement& placement, double separation) {
  const auto lines = polylines(placement);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const auto& point : lines[i]) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j < i; ++j) least = std::min(least, distance_to_polyline(point, lines[j]));
      CHECK(least >= separation * (1 - 1e-12));
    }
  }
}

/// The share of the edges' length, sampled, that is within d_sep of a line. Where it is not, and neither is what lies
/// within two sub-segments of the mask, no segment fits between the lines.
inline double check_filled(const SurfaceMesh& mesh, const OrientationField& field, const Placement& placement) {
  const double separation = placement.options.separation_distance;
  const auto lines = polylines(placement);
  const auto distance = [&](const EdgePoint& point) {
    double least = std::numeric_limits<double>::infinity();
    const detail::Vector place = detail::position(mesh, point);
    for (const auto& line : lines) least = std::min(least, distance_to_polyline(place, line));
    return least;
  };
  const RuledOccupancy strict(
      [&](const EdgePoint& point) { return distance(point) > separation + mesh.edge_lengths()[point.edge] / 32; });
  const StreamlineTracer tracer(mesh, field, {separation});
  const auto workspace = StreamlineTracer::make_workspace();
  double covered = 0, total = 0;
  int fit = 0;
  for (std::int32_t edge = 0; edge < static_cast<std::int32_t>(mesh.edges().size()); ++edge) {
    if (!tracer.start_triangle(edge)) continue;
    for (int i = 0; i < 8; ++i) {
      const EdgePoint point{edge, (i + 0.5) / 8};
      covered += (distance(point) <= separation) * mesh.edge_lengths()[edge];
      total += mesh.edge_lengths()[edge];
      if (strict.admits(0, point)) fit += !tracer.trace(point, &strict, *workspace).triangles.empty();
    }
  }
  CHECK(fit == 0);
  return covered / total;
}

}  // namespace pectinate::test
