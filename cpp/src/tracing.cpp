// SPDX-License-Identifier: MIT
#include "pectinate/tracing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "detail/crossings.hpp"
#include "detail/edge_point.hpp"
#include "detail/self_approach.hpp"
#include "detail/visited_chords.hpp"
#include "pectinate/errors.hpp"
#include "pectinate/occupancy.hpp"

namespace pectinate {
namespace {

using detail::Role;
using Workspace = StreamlineTracer::Workspace;

/// Below this share of the bounding box a separation distance is a matter of units, not of drawing.
constexpr double least_relative_separation = 1e-6;

void check(const SurfaceMesh& mesh, const OrientationField& field, const TracingOptions& options) {
  if (field.directions().size() != mesh.triangle_count()) {
    throw InvalidField("the field has " + std::to_string(field.directions().size()) + " directions, but the mesh has " +
                       std::to_string(mesh.triangle_count()) + " triangles; build the field from this mesh");
  }
  const double d = options.separation_distance, diagonal = mesh.bounding_box_diagonal();
  if (!std::isfinite(d) || !(d >= least_relative_separation * diagonal)) {
    throw InvalidOption("separation_distance is " + std::to_string(d) +
                        ", but must be finite and at least 1e-6 of the "
                        "mesh's diagonal, " +
                        std::to_string(diagonal) + "; give it in the unit of the mesh");
  }
  if (!(options.abrupt_turn_angle > 0 && options.abrupt_turn_angle <= std::numbers::pi)) {
    throw InvalidOption("abrupt_turn_angle is " + std::to_string(options.abrupt_turn_angle) +
                        ", but must be in (0, pi] radians; pi disables the criterion");
  }
  if (options.max_steps < 1) {
    throw InvalidOption("max_steps is " + std::to_string(options.max_steps) + ", but must be at least 1");
  }
}

}  // namespace

struct StreamlineTracer::Precomputed {
  const SurfaceMesh& mesh;
  const OrientationField& field;
  TracingOptions options;
  std::vector<detail::TriangleCrossings> crossings;  // per triangle
};

class StreamlineTracer::Workspace {
 public:
  Streamline streamline;
  detail::SelfApproach points;
  detail::VisitedChords chords;
};

namespace {

/// Where a streamline enters a triangle.
struct Entry {
  std::int32_t triangle;
  Role role;  // of the side that it enters through
};

/// What does not change along the way.
struct Tracing {
  const SurfaceMesh& mesh;
  const TracingOptions& options;
  const std::vector<detail::TriangleCrossings>& crossings;
  const Occupancy* occupancy;
};

/// Traces one way from the last point of the streamline and appends to it; `direction` is the sign of its arc length.
StopReason trace_one_way(const Tracing& tracing, Entry entry, double direction, Workspace& workspace) {
  auto& line = workspace.streamline;
  const double separation = tracing.options.separation_distance;
  double chord = detail::chord_coordinate(tracing.crossings[entry.triangle], entry.role, line.points.back().position);
  double length = 0;
  for (std::int64_t step = 0; step < tracing.options.max_steps; ++step) {
    const auto& crossings = tracing.crossings[entry.triangle];
    const Role role = entry.role != detail::low_high ? detail::low_high
                      : chord < crossings.split      ? detail::low_middle
                                                     : detail::middle_high;
    const auto& exit = crossings.exits[role];
    const EdgePoint point{exit.edge, detail::edge_position(crossings, role, chord)};
    if (tracing.occupancy && !tracing.occupancy->admits(entry.triangle, point)) return StopReason::near_other;
    const double piece = detail::chord_length(crossings, chord);
    const auto place = detail::position(tracing.mesh, point);
    if (workspace.points.is_near(place, direction * (length + piece)) ||
        workspace.chords.revisit(entry.triangle, chord, crossings.width, separation)) {
      return StopReason::near_itself;
    }
    length += piece;
    workspace.points.add(place, direction * length);
    line.points.push_back(point);
    line.triangles.push_back(entry.triangle);
    line.length += piece;
    if (exit.triangle < 0) return exit.stop_reason;
    entry = {exit.triangle, exit.role};
    chord = detail::chord_coordinate(tracing.crossings[entry.triangle], entry.role, point.position);
  }
  return StopReason::max_steps;
}

Role role_with_edge(const detail::TriangleCrossings& crossings, std::int32_t edge) {
  if (crossings.exits[detail::low_high].edge == edge) return detail::low_high;
  return crossings.exits[detail::low_middle].edge == edge ? detail::low_middle : detail::middle_high;
}

}  // namespace

StreamlineTracer::StreamlineTracer(const SurfaceMesh& mesh, const OrientationField& field,
                                   const TracingOptions& options) {
  check(mesh, field, options);
  precomputed_ = std::make_unique<const Precomputed>(
      Precomputed{mesh, field, options, detail::make_crossings(mesh, field, options.abrupt_turn_angle)});
}

StreamlineTracer::~StreamlineTracer() = default;

const TracingOptions& StreamlineTracer::options() const {
  return precomputed_->options;
}

std::optional<std::int32_t> StreamlineTracer::start_triangle(std::int32_t edge) const {
  for (const auto t : precomputed_->mesh.edge_triangles(edge)) {
    if (precomputed_->field.has_direction(t)) return t;
  }
  return std::nullopt;
}

const Streamline& StreamlineTracer::trace(const EdgePoint& seed, const Occupancy* occupancy,
                                          Workspace& workspace) const {
  const auto& [mesh, field, options, crossings] = *precomputed_;
  const auto start = start_triangle(seed.edge);
  if (!start) {
    throw InvalidField("edge " + std::to_string(seed.edge) + " has no triangle with a direction; seed elsewhere");
  }
  auto& line = workspace.streamline;
  line.points.assign(1, {seed.edge, detail::clamp_position(seed.position)});
  line.triangles.clear();
  line.length = 0;
  const auto seed_place = detail::position(mesh, line.points[0]);
  workspace.points.start(options.separation_distance, seed_place);
  workspace.points.add(seed_place, 0);
  workspace.chords.start(crossings.size());

  const Tracing tracing{mesh, options, crossings, occupancy};
  const Entry ahead{*start, role_with_edge(crossings[*start], seed.edge)};
  const auto& behind = crossings[*start].exits[ahead.role];
  line.stop_reasons[0] = behind.stop_reason;
  if (behind.triangle >= 0) {
    line.stop_reasons[0] = trace_one_way(tracing, {behind.triangle, behind.role}, -1, workspace);
  }
  // The first half was traced away from the seed: turned round, the seed is its last point.
  std::reverse(line.points.begin(), line.points.end());
  std::reverse(line.triangles.begin(), line.triangles.end());
  line.seed_index = static_cast<std::int64_t>(line.triangles.size());
  line.stop_reasons[1] = trace_one_way(tracing, ahead, 1, workspace);
  return line;
}

std::unique_ptr<StreamlineTracer::Workspace, StreamlineTracer::WorkspaceDeleter> StreamlineTracer::make_workspace() {
  return std::unique_ptr<Workspace, WorkspaceDeleter>(new Workspace);
}

void StreamlineTracer::WorkspaceDeleter::operator()(Workspace* workspace) const {
  delete workspace;
}

}  // namespace pectinate
