// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "detail/vec.hpp"
#include "pectinate/surface_mesh.hpp"

namespace pectinate::detail {

/// A point of the surface and a triangle that holds it.
struct Place {
  std::int32_t triangle;
  Vector point;
};

/// A straight piece of a curve on the surface, from where the piece before it ends.
struct CurvePiece {
  std::int32_t triangle;  ///< that holds it
  Vector end;
  Vector direction;  ///< along the piece, any length; more exact than its ends where these are close together
};

/// Crossings nearer than this share of an edge to its end are moved there, so that no curve runs through a vertex.
inline constexpr double least_edge_share = 1e-10;

double curve_length(const Vector& start, const std::vector<CurvePiece>& pieces);

/// The shortest curve from `a` to `b` in which the plane through both, nearest to the surface's normals at both, cuts
/// the surface. None where that cut does not join them, or where such a plane is ill defined.
std::optional<std::vector<CurvePiece>> cut_by_normal_plane(const SurfaceMesh& mesh, const Place& a, const Place& b);

/// A curve on the surface from `a` to `b`, two places of one component: the cut by the normal plane, or a locally
/// shortest path if there is no cut, or only one with a detour. From `b` to `a` it is the same, to the last bit.
std::vector<CurvePiece> join(const SurfaceMesh& mesh, const Place& a, const Place& b);

}  // namespace pectinate::detail
