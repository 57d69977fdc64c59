// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "detail/vec.hpp"

namespace pectinate::detail {

/// Value and gradient at a point of a function that is negative inside, positive outside and grows like a distance.
struct Sample {
  double value;
  Vector gradient;
};

/// Axis-parallel, x²/a² + y²/b² + z²/c² = 1 about its centre.
struct Ellipsoid {
  Vector centre, radii;
};

struct Ball {
  Vector centre;
  double radius;
};

/// The convex hull of two spheres; neither may contain the other.
struct RoundCone {
  Vector start, end;
  double start_radius, end_radius;

  Vector axis() const { return (end - start).normalized(); }
};

/// What lies behind a plane.
struct HalfSpace {
  Vector point, normal;  ///< unit normal, outwards
};

Sample sample(const Ellipsoid& ellipsoid, const Vector& point);
Sample sample(const Ball& ball, const Vector& point);
Sample sample(const RoundCone& cone, const Vector& point);
Sample sample(const HalfSpace& half_space, const Vector& point);

/// Union with a fillet where both values differ by less than `width`; twice continuously differentiable.
Sample smooth_union(const Sample& a, const Sample& b, double width);

/// Intersection with its edges rounded likewise.
Sample smooth_intersection(const Sample& a, const Sample& b, double width);

/// Moved outwards, or inwards if negative.
inline Sample offset(const Sample& at, double distance) {
  return {at.value - distance, at.gradient};
}

/// The same zero set with a gradient of unit length on it.
Sample unit_slope(const Sample& at);

/// Takes away what lies beyond a plane, within `radius` of a point on it: other limbs beyond that plane stay whole.
struct PlanarCut {
  Vector centre, normal;  ///< unit normal, towards the part taken away
  double radius;

  double height(const Vector& point) const { return normal.dot(point - centre); }
};

/// Takes away what lies where a function is positive, within `radius` of a centre.
struct Cut {
  std::function<Sample(const Vector&)> function;  ///< its gradient has unit length where it is zero
  Vector centre;
  double radius;

  double height(const Vector& point) const { return function(point).value; }
  bool reaches(const Vector& point) const { return (point - centre).norm() < radius; }
};

Cut make_cut(const PlanarCut& plane);

struct Box {
  Vector lower, upper;
};

Box bounds(const Ellipsoid& ellipsoid);
/// Of both spheres.
Box bounds(const RoundCone& cone);
/// The smallest that holds both.
Box enclose(const Box& a, const Box& b);
/// Larger by `margin` on every side.
Box widen(const Box& box, double margin);

/// The zero set of `function`, closed before the cuts.
struct ImplicitSurface {
  std::function<Sample(const Vector&)> function;
  std::vector<Cut> cuts;
  Box bounds;  ///< contains all of the zero set that the cuts leave, and more
};

/// The point of the surface that Newton steps along the gradient lead to; exact to rounding near the surface.
Vector project(const ImplicitSurface& surface, const Vector& point);

/// The same along a cut: leads to its border curve.
Vector project_to_border(const ImplicitSurface& surface, const Cut& cut, const Vector& point);

}  // namespace pectinate::detail
