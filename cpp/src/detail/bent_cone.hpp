// SPDX-License-Identifier: MIT
#pragma once

#include "detail/implicit_surface.hpp"

namespace pectinate::detail {

/// A ball that rolls along an arc of a circle while its radius changes.
class BentCone {
 public:
  struct Ends {
    Vector start, end;
    double start_radius, end_radius;
  };

  /// The arc leaves the start along `direction`, which must not point at the end nor away from it.
  BentCone(const Ends& ends, const Vector& direction);

  Sample sample(const Vector& point) const;
  Box bounds() const;

 private:
  Sample sample_end(const Vector& point) const;

  Ends ends_;
  Vector forward_, inward_,
      across_;  ///< at the start: along the arc, towards the circle's centre, normal to the circle
  double arc_radius_, arc_angle_;
};

}  // namespace pectinate::detail
