// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "detail/chord_occupancy.hpp"

namespace pectinate::detail {

/// Which triangles have their centre within the separation distance of a line: a sample of the points that are covered.
/// Where a chord comes that near to a line with one end only, the occupancy says that it is taken; this does not.
class CoveredCentres {
 public:
  /// Lines cover so many separation distances.
  CoveredCentres(const SurfaceMesh& mesh, const StreamlineTracer& tracer, double clearance);

  /// Finds out which centres a line covers, of the triangles given, and counts them; the line has a number that is not
  /// in use.
  void add(std::int32_t line, const Polyline& polyline, const std::vector<std::int32_t>& triangles);
  void take_back(std::span<const std::int32_t> lines);
  /// Lines that were taken back.
  void put_back(std::span<const std::int32_t> lines);

  /// Of the triangles whose centres no line covers, less that of all triangles: so it only tells changes.
  double uncovered_area() const { return uncovered_area_; }

 private:
  /// Some segments of a line [first, last), and a ball that holds all points near enough to them.
  struct Bundle {
    std::size_t first, last;
    Vector centre;
    double radius;
  };

  std::vector<Bundle> bundles_of(const Polyline& line) const;
  bool is_covered(const Vector& point, const Polyline& line, const Bundle& bundle) const;
  double reach(std::int32_t triangle) const {
    return clearance_ * tracer_.separation_distance(sheet_.mesh_triangle(triangle));
  }
  double area(std::int32_t triangle) const { return mesh_.triangle_areas()[sheet_.mesh_triangle(triangle)]; }

  const SurfaceMesh& mesh_;
  const StreamlineTracer& tracer_;
  const Sheet& sheet_;
  double clearance_;
  std::vector<std::vector<std::int32_t>> covered_;  // per line: triangles
  std::vector<std::int32_t> counts_;                // per triangle: lines that cover its centre
  double uncovered_area_ = 0;
};

}  // namespace pectinate::detail
