// SPDX-License-Identifier: MIT
#include "pectinate/constraints.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "detail/boundary_demands.hpp"
#include "detail/capsule.hpp"
#include "detail/demands.hpp"
#include "detail/number_text.hpp"
#include "detail/tract_projection.hpp"
#include "detail/triangle_tree.hpp"
#include "pectinate/errors.hpp"

namespace pectinate {
namespace {

using detail::vector;

constexpr double default_maximum_distance = 0.01;  // of the bounding box's diagonal

void check_weight(double weight, const std::string& label) {
  if ((weight >= least_weight && weight <= greatest_weight) || weight == hard) return;
  throw InvalidOption(label + " has the weight " + detail::number_text(weight) +
                      ", but weights are from 1e-6 to 1e12, or hard; leave out what is to weigh less");
}

void check(const ConstraintOptions& options) {
  if (!(options.conflict_angle > 0 && options.conflict_angle <= std::numbers::pi / 2)) {
    throw InvalidOption("conflict_angle is " + detail::number_text(options.conflict_angle) +
                        ", but must be in (0, pi/2] radians");
  }
  if (options.maximum_distance && !(*options.maximum_distance > 0)) {
    throw InvalidOption("maximum_distance is " + detail::number_text(*options.maximum_distance) +
                        ", but must be positive; leave it out for a hundredth of the mesh's diagonal");
  }
}

void check(const SurfaceMesh& mesh, std::span<const BoundaryCondition> boundary) {
  std::vector<bool> given(mesh.boundary_loops().size(), false);
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const auto& [loop, rule, weight] = boundary[i];
    const std::string label = "boundary condition " + std::to_string(i);
    if (loop < 0 || static_cast<std::size_t>(loop) >= given.size()) {
      throw InvalidOption(label + " is for loop " + std::to_string(loop) + ", but the mesh has " +
                          std::to_string(given.size()) + " boundary loops, numbered from 0");
    }
    if (given[loop]) {
      throw InvalidOption(label + " is for loop " + std::to_string(loop) + ", which has one already; give one a loop");
    }
    if (rule > BoundaryRule::perpendicular) {
      throw InvalidOption(label + " has no known rule; rules are free, parallel and perpendicular");
    }
    check_weight(weight, label);
    given[loop] = true;
  }
}

}  // namespace

struct TractProjector::State {
  explicit State(const SurfaceMesh& surface)
      : mesh(surface), tree(surface), loop_sides(detail::find_loop_sides(surface)) {}

  const SurfaceMesh& mesh;
  detail::TriangleTree tree;
  std::vector<detail::LoopSides> loop_sides;
};

TractProjector::TractProjector(const SurfaceMesh& mesh) : state_(std::make_unique<const State>(mesh)) {}
TractProjector::TractProjector(TractProjector&&) noexcept = default;
TractProjector& TractProjector::operator=(TractProjector&&) noexcept = default;
TractProjector::~TractProjector() = default;

std::vector<SurfacePoint> TractProjector::nearest_surface_points(std::span<const Vec3> points) const {
  const auto& tree = state_->tree;
  std::vector<SurfacePoint> nearest;
  nearest.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto point = vector(points[i]);
    if (!(point.allFinite() && tree.box_distance(point) <= tree.reach())) {
      throw InvalidOption("point " + std::to_string(i) +
                          " is not finite, or farther away than 1e9 diagonals of the mesh");
    }
    nearest.push_back(tree.nearest(point));
  }
  return nearest;
}

Constraints TractProjector::make_constraints(std::span<const Tract> tracts, std::span<const BoundaryCondition> boundary,
                                             const ConstraintOptions& options) const {
  const auto& [mesh, tree, loop_sides] = *state_;
  check(options);
  check(mesh, boundary);
  const double maximum_distance =
      options.maximum_distance.value_or(default_maximum_distance * mesh.bounding_box_diagonal());
  Constraints constraints;
  std::vector<detail::Demand> demands;
  const auto append = [&](const std::vector<detail::Demand>& more) {
    demands.insert(demands.end(), more.begin(), more.end());
  };
  for (std::size_t i = 0; i < tracts.size(); ++i) {
    const auto label = detail::tract_label(i, tracts[i]);
    check_weight(tracts[i].weight, label);
    auto curve = detail::project_tract(mesh, tree, tracts[i], label, maximum_distance);
    const auto own =
        detail::tract_demands(mesh, curve, tracts[i], static_cast<std::int32_t>(i), options.conflict_angle);
    append(own.demands);
    constraints.conflicts.insert(constraints.conflicts.end(), own.conflicts.begin(), own.conflicts.end());
    constraints.tracts.push_back(std::move(curve.projected));
  }
  for (const auto& condition : boundary) {
    append(
        detail::boundary_demands(mesh, mesh.boundary_loops()[condition.loop], loop_sides[condition.loop], condition));
  }
  const auto settled = detail::settle(std::move(demands), options.conflict_angle);
  for (const auto& [triangle, phase, weight, tract] : settled.demands) {
    const auto direction = detail::direction_of(phase, detail::triangle_frame(mesh, triangle));
    constraints.triangles.push_back({triangle, detail::vec3(direction), weight, tract});
  }
  constraints.conflicts.insert(constraints.conflicts.end(), settled.conflicts.begin(), settled.conflicts.end());
  std::stable_sort(constraints.conflicts.begin(), constraints.conflicts.end(),
                   [](const auto& a, const auto& b) { return a.triangle < b.triangle; });
  return constraints;
}

std::vector<SurfacePoint> nearest_surface_points(const SurfaceMesh& mesh, std::span<const Vec3> points) {
  return TractProjector(mesh).nearest_surface_points(points);
}

std::int32_t nearest_boundary_loop(const SurfaceMesh& mesh, const Vec3& point) {
  const auto& loops = mesh.boundary_loops();
  if (loops.empty()) throw InvalidMesh("the surface is closed: it has no boundary loop to choose");
  if (!vector(point).allFinite()) throw InvalidOption("the point to find the nearest boundary loop of is not finite");
  const auto at = [&](std::int32_t v) { return vector(mesh.vertices()[v]); };
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t l = 0; l < loops.size(); ++l) {
    const auto& vertices = loops[l].vertices;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const double distance =
          detail::distance_to_segment(vector(point), at(vertices[i]), at(vertices[(i + 1) % vertices.size()]));
      if (distance >= least) continue;
      least = distance;
      nearest = l;
    }
  }
  return static_cast<std::int32_t>(nearest);
}

Constraints make_constraints(const SurfaceMesh& mesh, std::span<const Tract> tracts,
                             std::span<const BoundaryCondition> boundary, const ConstraintOptions& options) {
  return TractProjector(mesh).make_constraints(tracts, boundary, options);
}

}  // namespace pectinate
