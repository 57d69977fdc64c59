// SPDX-License-Identifier: MIT
#include "detail/implicit_surface.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace pectinate::detail {

namespace {

constexpr int max_newton_steps = 20;
constexpr double on_surface = 1e-12;

Vector newton_step(const Sample& at, const Vector& direction) {
  return -at.value / direction.squaredNorm() * direction;
}

}  // namespace

// Taubin's distance F / |grad F|, regularised: the true distance to an ellipsoid needs a root finder, and a factor
// between both does not matter here. The regularisation keeps the centre finite.
Sample sample(const Ellipsoid& ellipsoid, const Vector& point) {
  const Vector scaled = (point - ellipsoid.centre).cwiseQuotient(ellipsoid.radii);
  const Vector half_gradient = scaled.cwiseQuotient(ellipsoid.radii);
  const Vector curvature_term = half_gradient.cwiseQuotient(ellipsoid.radii).cwiseQuotient(ellipsoid.radii);
  const double level = (scaled.squaredNorm() - 1) / 2;
  const double slope = std::sqrt(half_gradient.squaredNorm() + 1e-9);
  return {level / slope, half_gradient / slope - level / (slope * slope * slope) * curvature_term};
}

Sample sample(const Ball& ball, const Vector& point) {
  const double distance = (point - ball.centre).norm();
  return {distance - ball.radius, (point - ball.centre) / std::max(distance, 1e-9)};
}

Sample sample(const RoundCone& cone, const Vector& point) {
  const Vector axis = cone.axis();
  const double length = (cone.end - cone.start).norm();
  const double sine = (cone.start_radius - cone.end_radius) / length;
  const double cosine = std::sqrt(1 - sine * sine);

  const Vector from_start = point - cone.start;
  const double along = axis.dot(from_start);
  const Vector radial = from_start - along * axis;
  const double across = radial.norm();
  const double foot = along * cosine - across * sine;
  if (foot < 0) return sample(Ball{cone.start, cone.start_radius}, point);
  if (foot > cosine * length) return sample(Ball{cone.end, cone.end_radius}, point);
  return {across * cosine + along * sine - cone.start_radius, cosine / std::max(across, 1e-9) * radial + sine * axis};
}

Sample sample(const HalfSpace& half_space, const Vector& point) {
  return {half_space.normal.dot(point - half_space.point), half_space.normal};
}

Sample smooth_union(const Sample& a, const Sample& b, double width) {
  const auto& [inner, outer] = a.value < b.value ? std::tie(a, b) : std::tie(b, a);
  const double h = std::max(1 - (outer.value - inner.value) / width, 0.0);
  return {inner.value - h * h * h * width / 6, inner.gradient + h * h / 2 * (outer.gradient - inner.gradient)};
}

Sample smooth_intersection(const Sample& a, const Sample& b, double width) {
  const auto complement = [](const Sample& at) { return Sample{-at.value, -at.gradient}; };
  return complement(smooth_union(complement(a), complement(b), width));
}

Sample unit_slope(const Sample& at) {
  const double slope = std::max(at.gradient.norm(), 1e-9);
  return {at.value / slope, at.gradient / slope};
}

Cut make_cut(const PlanarCut& plane) {
  const auto function = [plane](const Vector& point) { return Sample{plane.height(point), plane.normal}; };
  return {function, plane.centre, plane.radius};
}

Box bounds(const Ellipsoid& ellipsoid) {
  return {ellipsoid.centre - ellipsoid.radii, ellipsoid.centre + ellipsoid.radii};
}

Box bounds(const RoundCone& cone) {
  return enclose(widen({cone.start, cone.start}, cone.start_radius), widen({cone.end, cone.end}, cone.end_radius));
}

Box enclose(const Box& a, const Box& b) {
  return {a.lower.cwiseMin(b.lower), a.upper.cwiseMax(b.upper)};
}

Box widen(const Box& box, double margin) {
  return {(box.lower.array() - margin).matrix(), (box.upper.array() + margin).matrix()};
}

Vector project(const ImplicitSurface& surface, const Vector& point) {
  Vector moved = point;
  for (int step = 0; step < max_newton_steps; ++step) {
    const Sample at = surface.function(moved);
    if (std::abs(at.value) < on_surface) break;
    moved += newton_step(at, at.gradient);
  }
  return moved;
}

Vector project_to_border(const ImplicitSurface& surface, const Cut& cut, const Vector& point) {
  Vector moved = point;
  for (int step = 0; step < max_newton_steps; ++step) {
    const Sample above = cut.function(moved);
    moved -= above.value * above.gradient;
    const Sample at = surface.function(moved), along = cut.function(moved);
    if (std::abs(at.value) < on_surface && std::abs(along.value) < on_surface) break;
    moved += newton_step(at, at.gradient - along.gradient.dot(at.gradient) * along.gradient);
  }
  return moved;
}

}  // namespace pectinate::detail
