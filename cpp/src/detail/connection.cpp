// SPDX-License-Identifier: MIT
#include "detail/connection.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "detail/mesh_geometry.hpp"

namespace pectinate::detail {
namespace {

/// Edges whose opposite angles add up to nearly pi or more (not Delaunay) would get an infinite or a negative weight.
constexpr double least_dual_length = 1e-3;

/// The cotangent of the angle opposite a side.
double opposite_cotangent(const SurfaceMesh& mesh, std::int32_t t, int side) {
  const Vector tip = corner(mesh, t, side + 2);
  const Vector u = corner(mesh, t, side) - tip, v = corner(mesh, t, side + 1) - tip;
  return u.dot(v) / (2 * mesh.triangle_areas()[t]);
}

Phase in_frame(const Vector& direction, const TriangleFrame& frame) {
  return {direction.dot(frame.along), direction.dot(frame.across)};
}

std::vector<std::int32_t> number_backs(const SurfaceMesh& mesh, std::int32_t& node_count) {
  std::vector<std::int32_t> back(mesh.triangle_count(), -1);
  for (std::size_t t = 0; t < back.size(); ++t) {
    if (!mesh.components()[mesh.triangle_components()[t]].orientable) back[t] = node_count++;
  }
  return back;
}

/// What joins a triangle to the one across a side: transport from front to front, or to the back across a seam.
struct Joint {
  std::int32_t other;
  bool seam;
  Phase transport;
  double weight;
};

Joint joint_at(const SurfaceMesh& mesh, std::int32_t t, int side, const SideNeighbour& across) {
  const bool seam = mesh.runs_along(t, side) == mesh.runs_along(across.triangle, across.side);
  const Vector edge = corner(mesh, t, side + 1) - corner(mesh, t, side);
  Phase here = in_frame(edge, triangle_frame(mesh, t));
  Phase there = in_frame(edge, triangle_frame(mesh, across.triangle));
  if (seam) there = std::conj(there);
  const Phase quotient = there / here;
  const double dual_length =
      (opposite_cotangent(mesh, t, side) + opposite_cotangent(mesh, across.triangle, across.side)) / 2;
  return {across.triangle, seam, quotient * quotient / std::norm(quotient),
          1 / std::max(dual_length, least_dual_length)};
}

}  // namespace

TriangleFrame triangle_frame(const SurfaceMesh& mesh, std::int32_t t) {
  const Vector along = (corner(mesh, t, 1) - corner(mesh, t, 0)).normalized();
  return {along, vector(mesh.triangle_normals()[t]).cross(along)};
}

Phase phase_of(const Vector& direction, const TriangleFrame& frame) {
  const Phase line = in_frame(direction, frame);
  return line * line / std::norm(line);
}

Vector direction_of(const Phase& phase, const TriangleFrame& frame) {
  const double cosine = phase.real() / std::sqrt(std::norm(phase));
  double along = std::sqrt((1 + cosine) / 2);  // half the angle, by whichever root is far from 0
  double across = std::sqrt((1 - cosine) / 2);
  (cosine > 0 ? across : along) = std::abs(phase.imag()) / std::sqrt(std::norm(phase)) / (2 * std::max(along, across));
  return std::copysign(along, phase.imag()) * frame.along + across * frame.across;
}

Connection make_connection(const SurfaceMesh& mesh) {
  Connection connection{{}, {}, static_cast<std::int32_t>(mesh.triangle_count())};
  connection.back = number_backs(mesh, connection.node_count);
  const auto& back = connection.back;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    for (int side = 0; side < 3; ++side) {
      const SideNeighbour across = mesh.neighbour(t, side);
      if (across.triangle < 0 || std::pair(across.triangle, int{across.side}) < std::pair(t, side)) continue;
      const auto [other, seam, transport, weight] = joint_at(mesh, t, side, across);
      if (back[t] < 0) {
        connection.edges.push_back({t, other, transport, weight});
        continue;
      }
      connection.edges.push_back({t, seam ? back[other] : other, transport, weight});
      connection.edges.push_back({back[t], seam ? other : back[other], std::conj(transport), weight});
    }
  }
  return connection;
}

}  // namespace pectinate::detail
