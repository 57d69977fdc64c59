// SPDX-License-Identifier: MIT
#include "detail/surface_curve.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "detail/mesh_geometry.hpp"
#include "detail/shortest_path.hpp"

namespace pectinate::detail {
namespace {

/// A cut no longer than this times the straight distance is taken as it is.
constexpr double plain_ratio = 1.5;
/// Else it may be longer than the locally shortest path by this factor.
constexpr double greatest_detour = 1.25;
/// The plane is ill defined where the mean normal is as short as this, or as nearly in line with both points.
constexpr double least_normal_share = 0.05;

/// Moved off the triangle's sides, so that every plane through the place cuts the triangle.
Vector inside(const SurfaceMesh& mesh, const Place& place) {
  const auto [a, b, c] = corners(mesh, place.triangle);
  return place.point + 3 * least_edge_share * ((a + b + c) / 3 - place.point);
}

/// A plane that cuts the surface. Each vertex is on one side of it, so that a triangle is cut through two sides or not
/// at all, and the cut never forks.
struct Plane {
  const SurfaceMesh& mesh;
  Vector origin, normal;
  Vector true_normal;  // before the places were moved inside their triangles: directions are exact

  double height(std::int32_t vertex) const { return normal.dot(vector(mesh.vertices()[vertex]) - origin); }
  std::int32_t corner(std::int32_t t, int k) const { return mesh.triangles()[t][k % 3]; }
  bool cuts(std::int32_t t, int side) const {
    return (height(corner(t, side)) >= 0) != (height(corner(t, side + 1)) >= 0);
  }
  /// The side through which a cut that comes in through `entry` goes out; the first that is cut if `entry` is none.
  std::optional<int> exit(std::int32_t t, int entry) const {
    for (int side = 0; side < 3; ++side) {
      if (side != entry && cuts(t, side)) return side;
    }
    return std::nullopt;
  }
  Vector crossing(std::int32_t t, int side) const {
    const std::int32_t a = corner(t, side), b = corner(t, side + 1);
    const double share = height(a) / (height(a) - height(b));
    const double position = std::clamp(share, least_edge_share, 1 - least_edge_share);
    return (1 - position) * vector(mesh.vertices()[a]) + position * vector(mesh.vertices()[b]);
  }
  CurvePiece piece(std::int32_t t, const Vector& end) const {
    return {t, end, true_normal.cross(vector(mesh.triangle_normals()[t]))};
  }
};

/// Follows the cut out of the first triangle through `side` until it comes to `b`, unless it ends at a border, comes
/// back, or grows longer than `limit`.
std::optional<std::vector<CurvePiece>> follow(const Plane& plane, const Place& a, const Place& b, int side,
                                              double limit) {
  std::vector<CurvePiece> pieces;
  Vector last = a.point;
  double length = 0;
  for (std::int32_t t = a.triangle; t != b.triangle;) {
    const Vector point = plane.crossing(t, side);
    length += (point - last).norm();
    last = point;
    pieces.push_back(plane.piece(t, point));
    const auto across = plane.mesh.neighbour(t, side);
    t = across.triangle;
    const bool ended = t < 0 || t == a.triangle || length > limit || pieces.size() > plane.mesh.triangle_count();
    const auto exit = ended ? std::nullopt : plane.exit(t, across.side);
    if (!exit) return std::nullopt;
    side = *exit;
  }
  pieces.push_back(plane.piece(b.triangle, b.point));
  return pieces;
}

/// The sum of the normals at both places; where the surface has no two sides, of those signs that agree.
Vector common_normal(const SurfaceMesh& mesh, const Place& a, const Place& b) {
  const Vector one = vector(mesh.triangle_normals()[a.triangle]), other = vector(mesh.triangle_normals()[b.triangle]);
  const bool orientable = mesh.components()[mesh.triangle_components()[a.triangle]].orientable;
  return orientable || one.dot(other) >= 0 ? Vector(one + other) : Vector(one - other);
}

std::vector<CurvePiece> reversed(const Vector& start, std::vector<CurvePiece> pieces) {
  for (std::size_t i = pieces.size(); i-- > 1;) pieces[i].end = pieces[i - 1].end;
  pieces[0].end = start;
  std::reverse(pieces.begin(), pieces.end());
  return pieces;
}

}  // namespace

double curve_length(const Vector& start, const std::vector<CurvePiece>& pieces) {
  double length = 0;
  const Vector* last = &start;
  for (const auto& piece : pieces) {
    length += (piece.end - *last).norm();
    last = &piece.end;
  }
  return length;
}

std::optional<std::vector<CurvePiece>> cut_by_normal_plane(const SurfaceMesh& mesh, const Place& a, const Place& b) {
  const Vector origin = inside(mesh, a), axis = inside(mesh, b) - origin, up = common_normal(mesh, a, b);
  const Vector normal = axis.cross(up), true_normal = (b.point - a.point).cross(up);
  if (!(normal.norm() > least_normal_share * axis.norm())) return std::nullopt;
  const Plane plane{mesh, origin, normal.normalized(), true_normal.normalized()};
  const auto first = plane.exit(a.triangle, -1);
  if (!first) return std::nullopt;
  // The way that leads towards `b` comes first: it bounds the other, which may lead far around.
  std::array<int, 2> ways{*first, plane.exit(a.triangle, *first).value_or(*first)};
  if ((plane.crossing(a.triangle, ways[0]) - plane.crossing(a.triangle, ways[1])).dot(axis) < 0) {
    std::swap(ways[0], ways[1]);
  }
  std::optional<std::vector<CurvePiece>> best;
  double least = std::numeric_limits<double>::infinity();
  for (const int side : ways) {
    auto pieces = follow(plane, a, b, side, least);
    if (!pieces) continue;
    const double length = curve_length(a.point, *pieces);
    if (length >= least) continue;
    least = length;
    best = std::move(pieces);
  }
  return best;
}

std::vector<CurvePiece> join(const SurfaceMesh& mesh, const Place& a, const Place& b) {
  if (a.triangle == b.triangle) return {{a.triangle, b.point, b.point - a.point}};
  if (a.triangle > b.triangle) return reversed(b.point, join(mesh, b, a));
  const auto cut = cut_by_normal_plane(mesh, a, b);
  if (!cut) return shortest_path(mesh, a, b);
  const double length = curve_length(a.point, *cut);
  if (length <= plain_ratio * (b.point - a.point).norm()) return *cut;
  const auto path = path_within(mesh, a, b, length);
  return path && greatest_detour * curve_length(a.point, *path) < length ? *path : *cut;
}

}  // namespace pectinate::detail
