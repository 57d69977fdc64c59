// SPDX-License-Identifier: MIT
#include "pectinate/field_topology.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "detail/connection.hpp"
#include "detail/mesh_geometry.hpp"

namespace pectinate {
namespace {

using detail::Phase;
using detail::Vector;
using detail::vector;
using std::numbers::pi;

/// The turns of a field from triangle to triangle, and the walks round vertices and along loops that add them up.
class Turns {
 public:
  Turns(const SurfaceMesh& mesh, const OrientationField& field) : mesh_(mesh), field_(field) {}

  /// Where a walk is: in a triangle, at one of its corners, seen from its front (1) or its back (-1).
  struct Place {
    std::int32_t triangle;
    int corner, face;
  };
  struct Walk {
    double turn = 0;   ///< of the field
    double angle = 0;  ///< of the triangles' corners at the vertex
    bool complete = true;
    Place last;
  };

  /// Round a vertex from a triangle, to the left or to the right, until it comes back or to the border.
  Walk around(const Place& start, bool leftwards) const {
    Walk walk{.last = start};
    for (Place at = start;;) {
      walk.last = at;
      walk.angle += corner_angle(at);
      const bool along = leftwards == (at.face > 0);
      const int side = along ? (at.corner + 2) % 3 : at.corner;
      const SideNeighbour across = mesh_.neighbour(at.triangle, side);
      if (across.triangle < 0) return walk;
      if (field_.has_direction(at.triangle) && field_.has_direction(across.triangle)) {
        walk.turn += at.face * turn_across(at.triangle, side, across);
      } else {
        walk.complete = false;
      }
      const bool seam = is_seam(at.triangle, side, across);
      // The vertex is the end of the side's run on the one hand, its start on the other, and on a seam the same.
      const int corner = along != seam ? across.side : (across.side + 1) % 3;
      at = {across.triangle, corner, seam ? -at.face : at.face};
      if (at.triangle == start.triangle) return walk;
    }
  }

 private:
  bool is_seam(std::int32_t t, int side, const SideNeighbour& across) const {
    return mesh_.runs_along(t, side) == mesh_.runs_along(across.triangle, across.side);
  }

  Vector corner(std::int32_t t, int k) const { return detail::corner(mesh_, t, k); }

  double corner_angle(const Place& at) const {
    const Vector u = corner(at.triangle, at.corner + 1) - corner(at.triangle, at.corner);
    const Vector v = corner(at.triangle, at.corner + 2) - corner(at.triangle, at.corner);
    return std::atan2(u.cross(v).norm(), u.dot(v));
  }

  /// From a triangle to its neighbour, unfolded; radians in [-pi/2, pi/2], to the left seen from the triangle's front.
  /// Of right angles, which could be either, one is taken both ways.
  double turn_across(std::int32_t t, int side, const SideNeighbour& across) const {
    if (t < across.triangle) return least_turn(t, side, across);
    const double back = least_turn(across.triangle, across.side, {t, static_cast<std::int8_t>(side)});
    return is_seam(t, side, across) ? back : -back;
  }

  double least_turn(std::int32_t t, int side, const SideNeighbour& across) const {
    const Vector edge = corner(t, side + 1) - corner(t, side);
    const auto line = [&](std::int32_t triangle) {
      const auto frame = detail::triangle_frame(mesh_, triangle);
      return detail::phase_of(vector(field_.directions()[triangle]), frame) * std::conj(detail::phase_of(edge, frame));
    };
    const Phase here = line(t);
    const Phase there = is_seam(t, side, across) ? std::conj(line(across.triangle)) : line(across.triangle);
    return std::arg(there * std::conj(here)) / 2;
  }

  const SurfaceMesh& mesh_;
  const OrientationField& field_;
};

std::int32_t half_turns(double radians) {
  return static_cast<std::int32_t>(std::lround(radians / pi));
}

std::vector<bool> on_border(const SurfaceMesh& mesh) {
  std::vector<bool> border(mesh.vertices().size(), false);
  for (const auto& loop : mesh.boundary_loops()) {
    for (const auto v : loop.vertices) border[v] = true;
  }
  return border;
}

/// Some corner at every vertex.
std::vector<Turns::Place> some_corners(const SurfaceMesh& mesh) {
  std::vector<Turns::Place> places(mesh.vertices().size());
  for (std::int32_t t = static_cast<std::int32_t>(mesh.triangle_count()) - 1; t >= 0; --t) {
    for (int k = 0; k < 3; ++k) places[mesh.triangles()[t][k]] = {t, k, 1};
  }
  return places;
}

std::vector<Singularity> find_singularities(const SurfaceMesh& mesh, const Turns& turns,
                                            const std::vector<Turns::Place>& corners) {
  std::vector<Singularity> found;
  const auto border = on_border(mesh);
  for (std::size_t v = 0; v < mesh.vertices().size(); ++v) {
    if (border[v]) continue;
    const auto walk = turns.around(corners[v], true);
    const auto count = half_turns(walk.turn + 2 * pi - walk.angle);
    if (walk.complete && count != 0) found.push_back({static_cast<std::int32_t>(v), count, mesh.vertices()[v]});
  }
  return found;
}

/// The corner from which all triangles at a border vertex lie to the right, seen with the surface on the left of the
/// way from the vertex before: the triangle of that side.
Turns::Place first_corner(const SurfaceMesh& mesh, Turns::Place any, const Turns& turns, std::int32_t before) {
  for (const bool leftwards : {true, false}) {
    const auto end = turns.around(any, leftwards).last;
    const auto& corners = mesh.triangles()[end.triangle];
    for (const int side : {end.corner, (end.corner + 2) % 3}) {
      const bool towards = corners[side] == before;
      if (mesh.neighbour(end.triangle, side).triangle >= 0) continue;
      if (!towards && corners[(side + 1) % 3] != before) continue;
      return {end.triangle, end.corner, towards ? 1 : -1};
    }
  }
  return any;
}

std::optional<std::int32_t> turns_along(const SurfaceMesh& mesh, const Turns& turns, const BoundaryLoop& loop,
                                        const std::vector<Turns::Place>& corners) {
  double against_field = 0;
  for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
    const auto v = loop.vertices[i];
    const auto before = loop.vertices[(i + loop.vertices.size() - 1) % loop.vertices.size()];
    const auto walk = turns.around(first_corner(mesh, corners[v], turns, before), false);
    if (!walk.complete) return std::nullopt;
    against_field += pi - walk.angle - walk.turn;
  }
  return half_turns(against_field);
}

}  // namespace

FieldTopology field_topology(const SurfaceMesh& mesh, const OrientationField& field) {
  const Turns turns(mesh, field);
  const auto corners = some_corners(mesh);
  FieldTopology topology{find_singularities(mesh, turns, corners), {}};
  for (const auto& loop : mesh.boundary_loops()) {
    topology.loop_half_turns.push_back(turns_along(mesh, turns, loop, corners));
  }
  return topology;
}

double dirichlet_energy(const SurfaceMesh& mesh, const OrientationField& field) {
  const auto connection = detail::make_connection(mesh);
  const auto count = static_cast<std::int32_t>(mesh.triangle_count());
  std::vector<Phase> phase(connection.node_count, 0);
  for (std::int32_t t = 0; t < count; ++t) {
    if (!field.has_direction(t)) continue;
    phase[t] = detail::phase_of(vector(field.directions()[t]), detail::triangle_frame(mesh, t));
    if (connection.back[t] >= 0) phase[connection.back[t]] = std::conj(phase[t]);
  }
  double energy = 0;
  for (const auto& [first, second, transport, weight] : connection.edges) {
    if (phase[first] == 0.0 || phase[second] == 0.0) continue;
    const double share = first < count && connection.back[first] < 0 ? 0.5 : 0.25;  // seen from both faces
    energy += share * weight * std::norm(phase[second] - transport * phase[first]);
  }
  return energy;
}

}  // namespace pectinate
