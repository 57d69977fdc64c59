// SPDX-License-Identifier: MIT
#include "pectinate/tubes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "detail/number_text.hpp"
#include "detail/vec.hpp"
#include "pectinate/errors.hpp"

namespace pectinate {
namespace {

using detail::Vector;
using detail::vector;

/// Rings closer than this share of the radius would cross each other at every bend.
constexpr double least_ring_spacing = 0.1;

/// Where a tube has a ring, or an end.
struct Station {
  Vector place, tangent, normal;  // normal: of the surface
  double arc;
  double point;
};

struct PolylinePoint {
  Vector place, normal;
  double arc;
  double point;  // as Tubes::vertex_points
};

void check(const TubeOptions& options) {
  if (!(options.radius > 0) || !std::isfinite(options.radius)) {
    throw InvalidOption("tube radius is " + detail::number_text(options.radius) + ", but must be positive and finite");
  }
  if (!(options.taper_length >= 0) || !std::isfinite(options.taper_length)) {
    throw InvalidOption("taper_length is " + detail::number_text(options.taper_length) +
                        ", but must be finite and not negative; 0 gives blunt ends");
  }
  if (options.side_count < 3 || options.side_count > 12) {
    throw InvalidOption("side_count is " + std::to_string(options.side_count) + ", but must be in [3, 12]");
  }
  if (!(options.height > 0 && options.height <= 1)) {
    throw InvalidOption("tube height is " + detail::number_text(options.height) +
                        " of the width, but must be above 0 and at most 1; 1 is round");
  }
}

/// Equation (3) of the paper; blunt where the taper length is 0.
double tube_radius(const TubeOptions& options, double arc, double length) {
  if (options.taper_length == 0) return options.radius;
  const auto rise = [&](double s) { return -std::expm1(-s / options.taper_length); };
  return options.radius * rise(arc) * rise(length - arc);
}

bool is_closed(const Placement& placement, std::size_t i) {
  constexpr int fewest_sides = 3;
  const auto first = placement.offsets[i], last = placement.offsets[i + 1] - 1;
  return last - first >= fewest_sides && placement.points[first] == placement.points[last];
}

/// The points of streamline `i` with the normals of the surface beside them.
std::vector<PolylinePoint> polyline(const SurfaceMesh& mesh, const Placement& placement, std::size_t i) {
  const auto first = placement.offsets[i], last = placement.offsets[i + 1] - 1;
  const auto normal_of = [&](std::int64_t segment) {
    return vector(mesh.triangle_normals()[placement.segment_triangles[segment - static_cast<std::int64_t>(i)]]);
  };
  const bool wraps = is_closed(placement, i);
  std::vector<PolylinePoint> points;
  for (auto p = first; p <= last; ++p) {
    const Vector place = vector(placement.points[p]);
    const Vector before = normal_of(p > first ? p - 1 : (wraps ? last - 1 : first));
    const Vector after = normal_of(p < last ? p : (wraps ? first : last - 1));
    // Neighbours of a surface that cannot be oriented may disagree on their side.
    const Vector normal = before.dot(after) < 0 ? Vector(before - after) : Vector(before + after);
    const double arc = p == first ? 0 : points.back().arc + (place - points.back().place).norm();
    points.push_back({place, normal, arc, static_cast<double>(p)});
  }
  return points;
}

/// Where on its streamline a place at some length from the start is, as in Tubes::vertex_points.
double point_at(const std::vector<PolylinePoint>& points, double arc) {
  const auto after = std::ranges::upper_bound(points, arc, {}, &PolylinePoint::arc);
  if (after == points.begin()) return points.front().point;
  if (after == points.end()) return points.back().point;
  const auto& before = *std::prev(after);
  return before.point + (arc - before.arc) / (after->arc - before.arc);
}

/// Fills long segments so that the taper is followed, or a closed tube has rings enough to be one, and leaves out
/// points too close for rings. The two ends stay.
std::vector<PolylinePoint> resample(const std::vector<PolylinePoint>& points, bool is_closed,
                                    const TubeOptions& options) {
  const double length = points.back().arc;
  const double shortest = std::min(least_ring_spacing * options.radius, length / 4);
  const double tapered = options.taper_length > 0 ? std::min(options.taper_length / 2, length / 2) : length;
  const double longest = is_closed ? length / 4 : tapered;
  std::vector<PolylinePoint> kept{points.front()};
  for (std::size_t p = 1; p < points.size(); ++p) {
    const bool is_last = p + 1 == points.size();
    if (!is_last && (points[p].arc - kept.back().arc < shortest || length - points[p].arc < shortest)) continue;
    const auto from = kept.back();
    const auto pieces = static_cast<int>(std::ceil((points[p].arc - from.arc) / longest - 1e-9));
    for (int k = 1; k < pieces; ++k) {
      const double w = static_cast<double>(k) / pieces, arc = (1 - w) * from.arc + w * points[p].arc;
      kept.push_back({(1 - w) * from.place + w * points[p].place, (1 - w) * from.normal + w * points[p].normal, arc,
                      point_at(points, arc)});
    }
    kept.push_back(points[p]);
  }
  return kept;
}

std::vector<Station> stations(const std::vector<PolylinePoint>& points, bool is_closed) {
  std::vector<Station> result;
  const std::size_t last = points.size() - 1;
  for (std::size_t p = 0; p <= last; ++p) {
    // The first and the last point of a closed line are one.
    const auto& before = points[p > 0 ? p - 1 : (is_closed ? last - 1 : 0)];
    const auto& after = points[p < last ? p + 1 : (is_closed ? 1 : last)];
    const Vector arriving = (points[p].place - before.place).stableNormalized();
    const Vector leaving = (after.place - points[p].place).stableNormalized();
    Vector tangent = arriving + leaving;
    if (tangent.norm() < 1e-6) tangent = leaving;  // a U-turn has no bisector
    tangent.normalize();
    Vector normal = points[p].normal - points[p].normal.dot(tangent) * tangent;
    if (normal.norm() < 1e-6 * points[p].normal.norm() || normal.norm() == 0) normal = tangent.unitOrthogonal();
    normal.normalize();
    if (!result.empty() && normal.dot(result.back().normal) < 0) normal = -normal;
    result.push_back({points[p].place, tangent, normal, points[p].arc, points[p].point});
  }
  return result;
}

/// A closed line's last station, a copy of its first, may be turned against it: about the core of a Moebius strip, by
/// half a turn. All stations take their share of that, and the copy goes.
std::vector<Station> join_ends(std::vector<Station> stations) {
  const auto &first = stations.front(), &last = stations.back();
  const double twist = std::atan2(last.normal.cross(first.normal).dot(first.tangent), last.normal.dot(first.normal));
  const double length = last.arc;
  for (auto& station : stations) {
    station.normal = Eigen::AngleAxisd(twist * station.arc / length, station.tangent) * station.normal;
  }
  stations.pop_back();
  return stations;
}

/// Appends one tube to the rest.
class TubeBuilder {
 public:
  TubeBuilder(Tubes& tubes, const TubeOptions& options) : tubes_(tubes), options_(options) {}

  void add(const std::vector<Station>& stations) {
    const double length = stations.back().arc;
    const bool blunt = options_.taper_length == 0;
    const auto start = add_vertex(stations.front().place, stations.front().point);
    std::int32_t ring = -1;
    for (std::size_t i = blunt ? 0 : 1; i < stations.size() - (blunt ? 0 : 1); ++i) {
      const auto next = add_ring(stations[i], tube_radius(options_, stations[i].arc, length));
      ring < 0 ? close(start, next, true) : join(ring, next);
      ring = next;
    }
    close(add_vertex(stations.back().place, stations.back().point), ring, false);
    finish();
  }

  /// A tube whose last station is followed by its first, of the same thickness everywhere.
  void add_closed(const std::vector<Station>& stations) {
    const auto first = add_ring(stations.front(), options_.radius);
    auto ring = first;
    for (std::size_t i = 1; i < stations.size(); ++i) {
      const auto next = add_ring(stations[i], options_.radius);
      join(ring, next);
      ring = next;
    }
    join(ring, first);
    finish();
  }

 private:
  void finish() {
    tubes_.vertex_offsets.push_back(static_cast<std::int64_t>(tubes_.vertices.size()));
    tubes_.triangle_offsets.push_back(static_cast<std::int64_t>(tubes_.triangles.size()));
  }

  std::int32_t add_vertex(const Vector& place, double point) {
    tubes_.vertices.push_back(detail::vec3(place));
    tubes_.vertex_points.push_back(point);
    return static_cast<std::int32_t>(tubes_.vertices.size()) - 1;
  }

  std::int32_t add_ring(const Station& station, double radius) {
    const auto first = static_cast<std::int32_t>(tubes_.vertices.size());
    const Vector side = station.tangent.cross(station.normal);
    for (int k = 0; k < options_.side_count; ++k) {
      const double angle = 2 * std::numbers::pi * k / options_.side_count;
      const Vector up = options_.height * std::cos(angle) * station.normal;
      add_vertex(station.place + radius * (up + std::sin(angle) * side), station.point);
    }
    return first;
  }

  void join(std::int32_t ring, std::int32_t next) {
    for (int k = 0; k < options_.side_count; ++k) {
      const int l = (k + 1) % options_.side_count;
      tubes_.triangles.push_back({ring + k, ring + l, next + k});
      tubes_.triangles.push_back({ring + l, next + l, next + k});
    }
  }

  void close(std::int32_t apex, std::int32_t ring, bool at_start) {
    for (int k = 0; k < options_.side_count; ++k) {
      const int l = (k + 1) % options_.side_count;
      tubes_.triangles.push_back(at_start ? Triangle{apex, ring + l, ring + k} : Triangle{apex, ring + k, ring + l});
    }
  }

  Tubes& tubes_;
  const TubeOptions& options_;
};

}  // namespace

Tubes make_tubes(const SurfaceMesh& mesh, const Placement& placement, const TubeOptions& options) {
  check(options);
  Tubes tubes;
  tubes.vertex_offsets.push_back(0);
  tubes.triangle_offsets.push_back(0);
  TubeBuilder builder(tubes, options);
  for (std::size_t i = 0; i + 1 < placement.offsets.size(); ++i) {
    const bool closed = is_closed(placement, i);
    const auto places = stations(resample(polyline(mesh, placement, i), closed, options), closed);
    closed ? builder.add_closed(join_ends(places)) : builder.add(places);
  }
  return tubes;
}

}  // namespace pectinate
