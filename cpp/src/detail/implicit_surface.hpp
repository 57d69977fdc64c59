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

/// The convex hull of two spheres; neither may contain the other.
struct RoundCone {
  Vector start, end;
  double start_radius, end_radius;

  Vector axis() const { return (end - start).normalized(); }
};

Sample sample(const Ellipsoid& ellipsoid, const Vector& point);
Sample sample(const RoundCone& cone, const Vector& point);

/// Union with a fillet where both values differ by less than `width`; twice continuously differentiable.
Sample smooth_union(const Sample& a, const Sample& b, double width);

/// Takes away what lies beyond a plane, within `radius` of a point on it: other limbs beyond that plane stay whole.
struct PlanarCut {
  Vector centre, normal;  ///< unit normal, towards the part taken away
  double radius;

  double height(const Vector& point) const { return normal.dot(point - centre); }
  bool reaches(const Vector& point) const { return (point - centre).norm() < radius; }
};

struct Box {
  Vector lower, upper;
};

/// The zero set of `function`, closed before the cuts.
struct ImplicitSurface {
  std::function<Sample(const Vector&)> function;
  std::vector<PlanarCut> cuts;
  Box bounds;  ///< contains the zero set
};

/// The point of the surface that Newton steps along the gradient lead to; exact to rounding near the surface.
Vector project(const ImplicitSurface& surface, const Vector& point);

/// The same within the plane of a cut: leads to its border curve.
Vector project_to_border(const ImplicitSurface& surface, const PlanarCut& cut, const Vector& point);

}  // namespace pectinate::detail
