// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "detail/capsule.hpp"
#include "detail/crossings.hpp"
#include "detail/vec.hpp"
#include "pectinate/surface_mesh.hpp"

namespace pectinate::detail {

/// A triangle laid flat: x along its chords, w across them, from the low corner at the origin to the high one.
class ChordFrame {
 public:
  ChordFrame(const SurfaceMesh& mesh, std::int32_t triangle, const TriangleCrossings& crossings);

  /// A bound for the chords that enter a capsule, and whether it is reached inside the triangle.
  struct Reach {
    Interval chords;
    bool low_inside, high_inside;
  };
  /// None if the capsule misses the triangle's plane.
  std::optional<Reach> reach(const Capsule& capsule) const;

  /// The chords that enter a capsule: one interval, because capsule and triangle are convex. In closed form; none if
  /// the capsule misses the triangle.
  std::optional<Interval> shadow(const Capsule& capsule, const Reach& reach) const;

  double width() const { return width_; }

 private:
  bool contains(double x, double w) const;

  Vector low_, middle_, high_;
  Vector along_, across_, normal_;
  double high_x_, middle_x_;
  double split_, width_;
};

}  // namespace pectinate::detail
