// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "detail/candidate_tracer.hpp"
#include "detail/candidates.hpp"
#include "detail/chord_occupancy.hpp"
#include "detail/polyline.hpp"
#include "detail/triangle_marks.hpp"
#include "pectinate/surface_mesh.hpp"
#include "pectinate/tracing.hpp"

namespace pectinate::detail {

/// Narrower gaps between occupied chords hold no streamline.
inline constexpr double least_gap = 4 * least_position;

/// Where candidates come from: a pool of trajectories all over the surface, then those beside each placed streamline,
/// in the end those through the gaps that are left.
class CandidateSource {
 public:
  CandidateSource(const SurfaceMesh& mesh, const StreamlineTracer& tracer, const LineRules& rules,
                  const ChordOccupancy& occupancy, Candidates& candidates);

  /// d_sep in a triangle of the sheet, and everywhere; that is 0 where it varies.
  double separation(std::int32_t triangle) const { return tracer_.separation(triangle); }
  double separation() const { return tracer_.separation(); }

  /// Trajectories so close that the longest streamlines are never far from one: each triangle is crossed by one, or a
  /// few triangles away from one. False if `go_on` stopped it.
  bool fill_pool(const std::function<bool()>& go_on);

  /// Candidates that lie just outside the band of a streamline, given the triangles in which it changed the occupancy.
  /// Calls `make_room` before each.
  void add_hugging(const Polyline& line, const std::vector<std::int32_t>& changed,
                   const std::function<void()>& make_room);

  /// Candidates through the gaps of some triangles, but for triangles that another of them crosses; `start_in` says
  /// where in a gap they start.
  void add_in_gaps(const std::vector<std::int32_t>& triangles, const std::function<double(const Interval&)>& start_in);

  /// A candidate from there to its natural ends.
  Stretch add(const ChordPlace& start) { return tracer_.add(start, {.others = true}, false).stretch(); }
  bool is_free(const ChordPlace& start) const {
    return !occupancy_.stopped().contains(start.triangle, start.coordinate);
  }

 private:
  void serve(const Stretch& candidate);
  void serve_around(const Stretch& candidate, int rings, TriangleMarks& has_been_crossed);
  void push_beside(const Stretch& stretch, std::vector<std::int32_t>& triangles) const;
  void add_hugging(std::int32_t triangle);
  int rings_beside_hugging(const Polyline& line) const;
  bool is_served_near(std::int32_t triangle, int rings) const;
  bool is_sparse(std::int32_t triangle) const;

  double mean_edge_length_;
  const Sheet& sheet_;
  const LargeArray<TriangleCrossings>& crossings_;
  const ChordOccupancy& occupancy_;
  Candidates& candidates_;
  CandidateTracer tracer_;
  std::vector<Interval> intervals_;  // of the triangle at hand
  TriangleMarks served_;             // need no other candidate: of the pool, then beside the streamline placed last
};

}  // namespace pectinate::detail
