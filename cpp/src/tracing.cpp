// SPDX-License-Identifier: MIT
#include "pectinate/tracing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "detail/crossings.hpp"
#include "detail/edge_point.hpp"
#include "detail/fit_checks.hpp"
#include "detail/number_text.hpp"
#include "detail/self_approach.hpp"
#include "detail/sheet.hpp"
#include "detail/vec.hpp"
#include "detail/visited_chords.hpp"
#include "pectinate/errors.hpp"
#include "pectinate/occupancy.hpp"

namespace pectinate {
namespace {

using detail::Role;
using Workspace = StreamlineTracer::Workspace;

/// Below this share of the bounding box a separation distance is a matter of units, not of drawing.
constexpr double least_relative_separation = 1e-6;

void check_separation(double separation, double diagonal, const std::string& name) {
  if (std::isfinite(separation) && separation >= least_relative_separation * diagonal) return;
  throw InvalidOption(name + " is " + detail::number_text(separation) +
                      ", but must be finite and at least 1e-6 of the mesh's diagonal, " +
                      detail::number_text(diagonal) + "; give it in the unit of the mesh");
}

void check_separations(const SurfaceMesh& mesh, const TracingOptions& options) {
  const double diagonal = mesh.bounding_box_diagonal();
  const auto& separations = options.separation_distances;
  if (separations.empty()) {
    check_separation(options.separation_distance, diagonal, "separation_distance");
  } else if (separations.size() != mesh.triangle_count()) {
    throw InvalidOption("separation_distances has " + std::to_string(separations.size()) +
                        " values, but the mesh has " + std::to_string(mesh.triangle_count()) +
                        " triangles; give one for each");
  }
  for (std::size_t t = 0; t < separations.size(); ++t) {
    check_separation(separations[t], diagonal, "separation_distance of triangle " + std::to_string(t));
  }
}

void check(const SurfaceMesh& mesh, const OrientationField& field, const TracingOptions& options) {
  detail::check_is_on(mesh, field);
  check_separations(mesh, options);
  if (!(options.abrupt_turn_angle > 0 && options.abrupt_turn_angle <= std::numbers::pi)) {
    throw InvalidOption("abrupt_turn_angle is " + detail::number_text(options.abrupt_turn_angle) +
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
  detail::Sheet sheet;
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
  std::int32_t triangle;  // of the sheet
  Role role;              // of the side that it enters through
};

/// What does not change along the way.
struct Tracing {
  const SurfaceMesh& mesh;
  const TracingOptions& options;
  const detail::Sheet& sheet;
  const Occupancy* occupancy;
  double separation;  // at the seed
};

/// Traces one way from the last point of the streamline and appends to it; `direction` is the sign of its arc length.
StopReason trace_one_way(const Tracing& tracing, Entry entry, double direction, Workspace& workspace) {
  auto& line = workspace.streamline;
  const auto& all = tracing.sheet.crossings;
  double chord = detail::chord_coordinate(all[entry.triangle], entry.role, line.points.back().position);
  detail::Vector previous = detail::position(tracing.mesh, line.points.back());
  double length = 0;
  for (std::int64_t step = 0; step < tracing.options.max_steps; ++step) {
    const auto& crossings = all[entry.triangle];
    const auto triangle = tracing.sheet.mesh_triangle(entry.triangle);
    const Role role = detail::exit_role(crossings, entry.role, chord);
    const auto exit = crossings.exit(role);
    const auto point = detail::edge_point(tracing.mesh, triangle, crossings, role, chord);
    if (tracing.occupancy && !tracing.occupancy->admits(triangle, chord, point)) {
      return tracing.occupancy->stop_reason(triangle, chord);
    }
    const auto place = detail::position(tracing.mesh, point);
    const double piece = (place - previous).norm();
    if (workspace.points.is_near(place, direction * (length + piece)) ||
        workspace.chords.revisit(entry.triangle, chord, crossings.width, tracing.separation)) {
      return StopReason::near_itself;
    }
    length += piece;
    workspace.points.add(place, direction * length);
    line.points.push_back(point);
    line.triangles.push_back(triangle);
    line.length += piece;
    previous = place;
    if (exit.triangle < 0) return exit.stop_reason;
    entry = {exit.triangle, exit.role};
    chord = detail::chord_coordinate(all[entry.triangle], entry.role, point.position);
  }
  return StopReason::max_steps;
}

}  // namespace

StreamlineTracer::StreamlineTracer(const SurfaceMesh& mesh, const OrientationField& field,
                                   const TracingOptions& options) {
  check(mesh, field, options);
  precomputed_ = std::make_unique<const Precomputed>(
      Precomputed{mesh, field, options, detail::make_sheet(mesh, field, options.abrupt_turn_angle)});
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

bool StreamlineTracer::has_direction(std::int32_t triangle) const {
  return precomputed_->field.has_direction(triangle);
}

double StreamlineTracer::separation_distance(std::int32_t triangle) const {
  const auto& options = precomputed_->options;
  return options.separation_distances.empty() ? options.separation_distance : options.separation_distances[triangle];
}

const detail::Sheet& StreamlineTracer::sheet() const {
  return precomputed_->sheet;
}

const Streamline& StreamlineTracer::trace(const Seed& seed, const Occupancy* occupancy, Workspace& workspace) const {
  const auto& [mesh, field, options, sheet] = *precomputed_;
  if (!field.has_direction(seed.triangle)) {
    throw InvalidField("triangle " + std::to_string(seed.triangle) + " has no direction; seed elsewhere");
  }
  auto& line = workspace.streamline;
  line.points.assign(1, {seed.point.edge, detail::clamp_position(seed.point.position)});
  line.triangles.clear();
  line.length = 0;
  const auto seed_place = detail::position(mesh, line.points[0]);
  workspace.points.start(separation_distance(seed.triangle), seed_place);
  workspace.points.add(seed_place, 0);
  workspace.chords.start(mesh.triangle_count());

  const Tracing tracing{mesh, options, sheet, occupancy, separation_distance(seed.triangle)};
  const auto triangle = sheet.ranks[seed.triangle];
  const auto& crossings = sheet.crossings[triangle];
  const Entry ahead{triangle, detail::role_with_edge(mesh, seed.triangle, crossings, seed.point.edge)};
  const auto behind = crossings.exit(ahead.role);
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

const Streamline& StreamlineTracer::trace(const EdgePoint& seed, const Occupancy* occupancy,
                                          Workspace& workspace) const {
  const auto triangle = start_triangle(seed.edge);
  if (!triangle) {
    throw InvalidField("edge " + std::to_string(seed.edge) + " has no triangle with a direction; seed elsewhere");
  }
  return trace(Seed{seed, *triangle}, occupancy, workspace);
}

std::unique_ptr<StreamlineTracer::Workspace, StreamlineTracer::WorkspaceDeleter> StreamlineTracer::make_workspace() {
  return std::unique_ptr<Workspace, WorkspaceDeleter>(new Workspace);
}

void StreamlineTracer::WorkspaceDeleter::operator()(Workspace* workspace) const {
  delete workspace;
}

}  // namespace pectinate
