// SPDX-License-Identifier: MIT
#include "detail/band.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace pectinate::detail {

namespace {

constexpr int pieces_per_span = 24;

/// Catmull and Rom's spline between the second and the third of four values.
template <typename Value>
Value spline(const std::array<Value, 4>& knots, double t) {
  const auto& [a, b, c, d] = knots;
  return b + t / 2 * ((c - a) + t * ((2 * a - 5 * b + 4 * c - d) + t * (3 * (b - c) + d - a)));
}

/// The knots around a span; those beyond the ends by reflection.
template <typename Value>
std::array<Value, 4> knots_of(const std::vector<Value>& values, std::size_t span) {
  const Value &b = values[span], &c = values[span + 1];
  const Value a = span > 0 ? values[span - 1] : Value(2 * b - c);
  const Value d = span + 2 < values.size() ? values[span + 2] : Value(2 * c - b);
  return {a, b, c, d};
}

}  // namespace

Band lay_band(const std::function<Sample(const Vector&)>& function, const std::vector<Vector>& points,
              const std::vector<double>& radii) {
  const ImplicitSurface surface{function, {}, {}};
  std::vector<Vector> knots;
  knots.reserve(points.size());
  for (const Vector& point : points) knots.push_back(project(surface, point));
  Band band;
  Vector start = knots.front();
  double start_radius = radii.front();
  band.bounds = {start, start};
  for (std::size_t span = 0; span + 1 < knots.size(); ++span) {
    const auto span_points = knots_of(knots, span);
    const auto span_radii = knots_of(radii, span);
    for (int piece = 1; piece <= pieces_per_span; ++piece) {
      const double t = static_cast<double>(piece) / pieces_per_span;
      const Vector end = project(surface, spline(span_points, t));
      const double end_radius = spline(span_radii, t);
      band.pieces.push_back({start, end, start_radius, end_radius});
      band.bounds = enclose(band.bounds, bounds(band.pieces.back()));
      start = end;
      start_radius = end_radius;
    }
  }
  return band;
}

Sample sample(const Band& band, const Vector& point) {
  Sample least{std::numeric_limits<double>::infinity(), Vector::Zero()};
  for (const RoundCone& piece : band.pieces) {
    const Sample at = sample(piece, point);
    if (at.value < least.value) least = at;
  }
  return least;
}

}  // namespace pectinate::detail
