// SPDX-License-Identifier: MIT
#include "detail/tract_projection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "detail/mesh_geometry.hpp"
#include "detail/number_text.hpp"
#include "detail/surface_curve.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::detail {
namespace {

/// Below this share of a triangle's longest side points are one.
constexpr double least_piece = 1e-9;

bool is_before(const Vector& a, const Vector& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

bool are_one(const SurfaceMesh& mesh, const Place& a, const Place& b) {
  const double side = std::max(longest_side(mesh, a.triangle), longest_side(mesh, b.triangle));
  return (a.point - b.point).norm() <= least_piece * side;
}

/// Of each run of points that are one keeps a point whose choice does not depend on the sense of the tract.
std::vector<Place> distinct(const SurfaceMesh& mesh, const std::vector<Place>& places) {
  std::vector<Place> kept;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i == 0 || !are_one(mesh, places[i - 1], places[i])) {
      kept.push_back(places[i]);
    } else if (is_before(places[i].point, kept.back().point)) {
      kept.back() = places[i];
    }
  }
  return kept;
}

/// A point of the curve, and the triangle and the direction of the segment that leads to it.
struct Step {
  Place place;
  Vector direction;
  bool given;  // a point of the tract, not a crossing
};

/// Segments too short to have a direction vanish, and the points that they join become one: a given point if there is
/// one, else the same whatever the sense.
TractCurve without_specks(const SurfaceMesh& mesh, const std::vector<Step>& steps) {
  TractCurve curve{};
  std::vector<Vector> points;
  bool given = true;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto& [place, direction, is_given] = steps[i];
    const double least = least_piece * longest_side(mesh, place.triangle);
    if (i == 0 || (place.point - steps[i - 1].place.point).norm() > least) {
      points.push_back(place.point);
      given = is_given;
      if (i == 0) continue;
      curve.projected.triangles.push_back(place.triangle);
      curve.directions.push_back(direction);
    } else if (is_given == given ? is_before(place.point, points.back()) : is_given) {
      points.back() = place.point;
      given = is_given;
    }
  }
  for (const auto& point : points) curve.projected.points.push_back(vec3(point));
  return curve;
}

struct JoinedPlaces {
  std::vector<Step> steps;
  double greatest_detour;
};

JoinedPlaces join_all(const SurfaceMesh& mesh, const std::vector<Place>& places) {
  JoinedPlaces joined{{{places[0], Vector::Zero(), true}}, 1};
  for (std::size_t i = 1; i < places.size(); ++i) {
    const auto pieces = join(mesh, places[i - 1], places[i]);
    for (const auto& piece : pieces) joined.steps.push_back({{piece.triangle, piece.end}, piece.direction, false});
    joined.steps.back().given = true;
    const double length = curve_length(places[i - 1].point, pieces);
    const double detour = length / (places[i].point - places[i - 1].point).norm();
    joined.greatest_detour = std::max(joined.greatest_detour, detour);
  }
  return joined;
}

void check_component(const SurfaceMesh& mesh, const std::vector<SurfacePoint>& nearest, const std::string& label) {
  for (std::size_t i = 1; i < nearest.size(); ++i) {
    const auto before = mesh.triangle_components()[nearest[i - 1].triangle];
    const auto here = mesh.triangle_components()[nearest[i].triangle];
    if (before == here) continue;
    throw InvalidOption(label + ": points " + std::to_string(i - 1) + " and " + std::to_string(i) +
                        " lie on different components of the surface, " + std::to_string(before) + " and " +
                        std::to_string(here) + "; make a tract for each");
  }
}

std::vector<SurfacePoint> nearest_points(const TriangleTree& tree, const Tract& tract, const std::string& label,
                                         double maximum_distance) {
  std::vector<SurfacePoint> nearest;
  nearest.reserve(tract.points.size());
  const double limit = std::min(maximum_distance, tree.reach());
  for (std::size_t i = 0; i < tract.points.size(); ++i) {
    const auto point = vector(tract.points[i]);
    if (!point.allFinite()) throw InvalidOption(label + ": point " + std::to_string(i) + " is not finite");
    double distance = tree.box_distance(point);
    if (distance <= tree.reach()) {
      nearest.push_back(tree.nearest(point));
      distance = nearest.back().distance;
    }
    if (distance <= limit) continue;
    throw InvalidOption(label + ": point " + std::to_string(i) + " is " + number_text(distance) +
                        " away from the surface, but may be " + number_text(limit) +
                        "; check its unit and its place, or allow a greater maximum_distance");
  }
  return nearest;
}

}  // namespace

std::string tract_label(std::size_t index, const Tract& tract) {
  const std::string label = "tract " + (tract.number ? std::to_string(*tract.number) : std::to_string(index));
  return tract.name.empty() ? label : label + " \"" + tract.name + "\"";
}

TractCurve project_tract(const SurfaceMesh& mesh, const TriangleTree& tree, const Tract& tract,
                         const std::string& label, double maximum_distance) {
  const auto nearest = nearest_points(tree, tract, label, maximum_distance);
  check_component(mesh, nearest, label);
  std::vector<Place> places;
  double greatest = 0;
  for (const auto& [triangle, point, distance] : nearest) {
    places.push_back({triangle, vector(point)});
    greatest = std::max(greatest, distance);
  }
  TractCurve curve{};
  if (!places.empty()) {
    const auto [steps, greatest_detour] = join_all(mesh, distinct(mesh, places));
    curve = without_specks(mesh, steps);
    curve.projected.greatest_detour = greatest_detour;
  }
  if (curve.directions.empty()) {
    throw InvalidOption(label + " has fewer than two distinct points on the surface, but needs two for a direction");
  }
  curve.projected.greatest_distance = greatest;
  const auto &first = curve.projected.points.front(), &last = curve.projected.points.back();
  curve.closed = are_one(mesh, {curve.projected.triangles.front(), vector(first)},
                         {curve.projected.triangles.back(), vector(last)});
  return curve;
}

}  // namespace pectinate::detail
