// SPDX-License-Identifier: MIT
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "detail/segment_distance.hpp"
#include "detail/sheet.hpp"
#include "lines.hpp"
#include "pectinate/occupancy.hpp"
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

/// A piece of a streamline, or a chord of a triangle.
struct Piece {
  detail::Vector start, end;
  std::size_t line = 0;
  double arc = 0, arc_end = 0;     // of its ends, along the streamline
  double separation_distance = 0;  // of its triangle

  double length() const { return (end - start).norm(); }
  double distance(const Piece& other) const { return detail::segment_distance(start, end, other.start, other.end); }
  /// Of the end that is farther away: no point of this piece is farther.
  double greatest_distance(const Piece& other) const {
    return std::max(detail::distance_to_segment(start, other.start, other.end),
                    detail::distance_to_segment(end, other.start, other.end));
  }
  /// At a glance; false does not say that it is not.
  bool is_farther_than(const Piece& other, double distance) const {
    const detail::Vector between = start + end - other.start - other.end;
    return between.norm() / 2 - (length() + other.length()) / 2 > distance;
  }
};

/// How much room a chord has beside a segment, in separation distances: for a streamline to go on, 1 is enough.
inline double room(const Piece& chord, const Piece& segment, double stop_clearance) {
  return chord.distance(segment) / (stop_clearance * segment.separation_distance);
}
/// For one to start, as well, some point of it must keep the greater distance.
inline double seed_room(const Piece& chord, const Piece& segment, const Clearance& clearance) {
  return std::min(room(chord, segment, clearance.stop),
                  chord.greatest_distance(segment) / (clearance.seed * segment.separation_distance));
}

inline std::vector<Piece> segments_of(const Placement& placement) {
  const auto& separations = placement.options.separation_distances;
  std::vector<Piece> segments;
  const auto lines = polylines(placement);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    double arc = 0;
    for (std::size_t k = 0; k + 1 < lines[i].size(); ++k) {
      Piece piece{lines[i][k], lines[i][k + 1], i, arc, arc, placement.options.separation_distance};
      piece.arc_end = arc += piece.length();
      const auto triangle = placement.segment_triangles[segments.size()];
      if (!separations.empty()) piece.separation_distance = separations[triangle];
      segments.push_back(piece);
    }
  }
  return segments;
}

/// The lines as they were placed: without the ends in the midst of triangles, to which they ran on when all were there.
inline Placement as_placed(const Placement& placement) {
  Placement result;
  result.options = placement.options;
  result.offsets.push_back(0);
  const auto lies_inside = [&](std::int64_t p) {
    const auto& weights = placement.barycentric[p];
    return std::count(weights.begin(), weights.end(), 0.0) == 0;
  };
  for (std::size_t i = 0; i < placement.lengths.size(); ++i) {
    const auto first = placement.offsets[i] + lies_inside(placement.offsets[i]);
    const auto last = placement.offsets[i + 1] - 1 - lies_inside(placement.offsets[i + 1] - 1);
    double length = 0;
    for (auto p = first; p <= last; ++p) {
      result.points.push_back(placement.points[p]);
      if (p == last) break;
      result.segment_triangles.push_back(placement.point_triangles[p]);
      length += (detail::vector(placement.points[p + 1]) - detail::vector(placement.points[p])).norm();
    }
    result.offsets.push_back(static_cast<std::int64_t>(result.points.size()));
    result.lengths.push_back(length);
  }
  return result;
}

/// The chord of a mesh triangle with this coordinate.
inline Piece chord_segment(const detail::Sheet& sheet, std::int32_t triangle, double chord) {
  const auto rank = sheet.ranks[triangle];
  const auto other = detail::exit_role(sheet.crossings[rank], detail::low_high, chord);
  return {sheet.point(rank, detail::low_high, chord), sheet.point(rank, other, chord)};
}

inline bool same_bytes(const Placement& a, const Placement& b) {
  return a.points == b.points && a.offsets == b.offsets && a.segment_triangles == b.segment_triangles &&
         a.point_triangles == b.point_triangles && a.barycentric == b.barycentric && a.lengths == b.lengths &&
         a.stop_reasons == b.stop_reasons && a.seed_points == b.seed_points &&
         a.statistics.coverage == b.statistics.coverage;
}

/// Points lie on sides, not on vertices, but for ends of streamlines that stop near others or themselves.
inline void check_points(const SurfaceMesh& mesh, const Placement& placement) {
  std::vector<std::uint8_t> may_lie_inside(placement.points.size(), 0);
  const auto is_near = [](StopReason reason) {
    return reason == StopReason::near_other || reason == StopReason::near_itself;
  };
  for (std::size_t i = 0; i < placement.lengths.size(); ++i) {
    const auto& reasons = placement.stop_reasons[i];
    may_lie_inside[placement.offsets[i]] = is_near(reasons[0]);
    may_lie_inside[placement.offsets[i + 1] - 1] = is_near(reasons[1]);
  }
  for (std::size_t p = 0; p < placement.points.size(); ++p) {
    const auto t = placement.point_triangles[p];
    const auto& weights = placement.barycentric[p];
    CHECK(weights[0] + weights[1] + weights[2] == doctest::Approx(1).epsilon(1e-15));
    CHECK(*std::min_element(weights.begin(), weights.end()) >= 0);
    const auto zero_count = std::count(weights.begin(), weights.end(), 0.0);
    CHECK((zero_count == 1 || (zero_count == 0 && may_lie_inside[p])));
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

/// With exact occupancy: whole streamlines are at least d_sep apart.
inline void check_segment_separation(const Placement& placement, double separation) {
  const auto segments = segments_of(placement);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < segments.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (segments[i].line == segments[j].line || segments[i].is_farther_than(segments[j], separation)) continue;
      least = std::min(least, segments[i].distance(segments[j]));
    }
  }
  CHECK(least >= separation);
}

inline std::int64_t stop_count(const Placement& placement, StopReason reason) {
  return placement.statistics.stop_counts[static_cast<std::size_t>(reason)];
}

inline bool is_closed(const Placement& placement, std::size_t line) {
  return placement.stop_reasons[line][0] == StopReason::closed;
}

/// With method longest: parts of a streamline that are more than 2 d_sep apart along it, round a closed one the shorter
/// way, are at least d_sep apart.
inline void check_self_separation(const Placement& placement, double separation) {
  const auto segments = segments_of(placement);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    for (std::size_t j = i; j-- > 0 && segments[j].line == segments[i].line;) {
      const double way_round = placement.lengths[segments[i].line] - segments[i].arc_end + segments[j].arc;
      if (segments[i].arc - segments[j].arc_end <= 2 * separation * (1 + 1e-9)) continue;
      if (is_closed(placement, segments[i].line) && way_round <= 2 * separation * (1 + 1e-9)) continue;
      if (segments[i].is_farther_than(segments[j], separation)) continue;
      CHECK(segments[i].distance(segments[j]) >= separation * (1 - 1e-9));
    }
  }
}

/// From an end of a streamline to the nearest of the others, over the distance that they shall keep; and of its own
/// parts with more than 2 d_sep of it between, over d_sep.
inline double room_at_end(const std::vector<Piece>& segments, const Placement& placement, std::size_t line, int end) {
  const auto p = end == 0 ? placement.offsets[line] : placement.offsets[line + 1] - 1;
  const detail::Vector point = detail::vector(placement.points[p]);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& segment : segments) {
    const double between = end == 0 ? segment.arc : placement.lengths[line] - segment.arc_end;
    const bool is_own = segment.line == line;
    if (is_own && between <= 2 * segment.separation_distance) continue;
    const double kept = segment.separation_distance * (is_own ? 1 : placement.options.test_distance);
    least = std::min(least, detail::distance_to_segment(point, segment.start, segment.end) / kept);
  }
  return least;
}

/// With method longest and one d_sep: streamlines that stop near others run on until these are as near as they may be.
inline void check_ends_near_others(const Placement& placement) {
  const auto segments = segments_of(placement);
  for (std::size_t i = 0; i < placement.lengths.size(); ++i) {
    for (const int end : {0, 1}) {
      if (placement.stop_reasons[i][end] != StopReason::near_other) continue;
      CHECK(room_at_end(segments, placement, i, end) <= 1 + 2e-3);
    }
  }
}

/// The same for ends in the midst of triangles of streamlines that stop near themselves; returns how many there are.
/// What others stopped for may have been left out.
inline int check_ends_near_themselves(const Placement& placement) {
  const auto segments = segments_of(placement);
  int count = 0;
  for (std::size_t i = 0; i < placement.lengths.size(); ++i) {
    for (const int end : {0, 1}) {
      const auto& weights = placement.barycentric[end == 0 ? placement.offsets[i] : placement.offsets[i + 1] - 1];
      if (placement.stop_reasons[i][end] != StopReason::near_itself || std::ranges::count(weights, 0.0) > 0) continue;
      CHECK(room_at_end(segments, placement, i, end) <= 1 + 2e-3);
      ++count;
    }
  }
  return count;
}

/// With exact occupancy: each streamline had, somewhere, room to start beside those placed before it; those of method
/// longest that are long need none if all keep d_sep.
inline void check_room_to_start(const Placement& final_placement) {
  const auto placement = as_placed(final_placement);
  const auto segments = segments_of(placement);
  const Clearance clearance{placement.options.test_distance, placement.options.seed_clearance};
  std::vector<double> greatest(placement.lengths.size(), 0);
  for (const auto& segment : segments) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& other : segments) {
      if (other.line >= segment.line) break;
      if (segment.is_farther_than(other, 3 * other.separation_distance)) continue;
      least = std::min(least, seed_room(segment, other, clearance));
    }
    greatest[segment.line] = std::max(greatest[segment.line], least);
  }
  const bool may_be_long = placement.options.method == PlacementMethod::longest && clearance.stop == 1;
  for (std::size_t i = 0; i < greatest.size(); ++i) {
    const bool is_long = may_be_long && placement.lengths[i] >= 9 * placement.options.separation_distance * (1 - 1e-6);
    CHECK((is_long || greatest[i] >= 1));
  }
}

/// With exact occupancy: no chord is left at which a streamline could start.
inline void check_complete(const SurfaceMesh& mesh, const OrientationField& field, const Placement& placement,
                           int chords_per_triangle = 20) {
  const auto segments = segments_of(placement);
  const auto sheet = detail::make_sheet(mesh, field, 1);
  const Clearance clearance{placement.options.test_distance, placement.options.seed_clearance};
  int free = 0;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    if (!field.has_direction(t)) continue;
    for (int i = 0; i < chords_per_triangle; ++i) {
      const auto chord = chord_segment(sheet, t, (i + 0.5) / chords_per_triangle);
      free += std::none_of(segments.begin(), segments.end(), [&](const auto& other) {
        return !chord.is_farther_than(other, 1.01 * clearance.seed * other.separation_distance) &&
               seed_room(chord, other, clearance) < 1 + 1e-5;
      });
    }
  }
  CHECK(free == 0);
}

/// With the edge mask. The share of the edges' length, sampled, that is within d_sep of a line. Where it is not, and
/// neither is what lies within two sub-segments of the mask, no segment fits between the lines.
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
      if (strict.admits(0, 0.5, point)) fit += !tracer.trace(point, &strict, *workspace).triangles.empty();
    }
  }
  CHECK(fit == 0);
  return covered / total;
}

}  // namespace pectinate::test
