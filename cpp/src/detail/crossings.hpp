// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "pectinate/surface_mesh.hpp"
#include "pectinate/tracing.hpp"

namespace pectinate::detail {

/// A side's part in the chords of its triangle. Across the field the three corners lie in the order low, middle, high:
/// every chord crosses the side low-high and one of the others.
enum Role : std::int8_t { low_high = 0, low_middle = 1, middle_high = 2 };

/// What lies beyond a side.
struct Exit {
  std::int32_t triangle;   ///< -1 where streamlines stop
  Role role;               ///< of this side in that triangle
  StopReason stop_reason;  ///< where there is no triangle to go on to
};

/// A triangle's precomputed crossings (paper section 2.4). A chord has the coordinate s in (0, 1) at which it crosses
/// the side low-high; it leaves through low-middle where s < split, through middle-high where s > split. `split` is
/// the paper's critical coordinate s_c of that side.
///
/// Tracing goes from record to record all over the surface: a cache line holds two.
struct alignas(32) TriangleCrossings {
  double split;                            ///< 0 in a triangle without a direction
  std::array<std::int32_t, 3> neighbours;  ///< by Role, also where streamlines stop; -1 at borders
  std::array<std::uint8_t, 3> codes;       ///< by Role: see `make_code`
  std::uint8_t middle;                     ///< the corner that the side low-high misses
  float longest_chord;                     ///< through the middle corner
  float width;                             ///< across the field, from the low corner to the high one

  /// Of a side that is `role_there` in the triangle beyond; `stop` is 0 where streamlines go on, else reason + 1.
  static std::uint8_t make_code(Role role_there, bool reversed, int stop) {
    return static_cast<std::uint8_t>(role_there | (reversed ? 4 : 0) | stop << 3);
  }
  /// The chord coordinate runs against the edge.
  bool is_reversed(Role role) const { return codes[role] & 4; }
  Exit exit(Role role) const {
    const int stop = codes[role] >> 3;
    return {stop == 0 ? neighbours[role] : -1, static_cast<Role>(codes[role] & 3),
            static_cast<StopReason>(stop == 0 ? 0 : stop - 1)};
  }
};

/// The part of triangle side `side` in the chords, given the corner that lies in the middle.
inline Role role_of(int side, int middle) {
  static constexpr Role roles[3][3] = {
      {low_middle, low_high, middle_high}, {middle_high, low_middle, low_high}, {low_high, middle_high, low_middle}};
  return roles[middle][side];
}

/// And back.
inline int side_of(Role role, int middle) {
  static constexpr std::int8_t sides[3][3] = {{1, 0, 2}, {2, 1, 0}, {0, 2, 1}};
  return sides[middle][role];
}

/// The edge on which a side of a mesh triangle lies.
inline std::int32_t edge_of(const SurfaceMesh& mesh, std::int32_t triangle, const TriangleCrossings& crossings,
                            Role role) {
  return mesh.triangle_edges()[triangle][side_of(role, crossings.middle)];
}

/// The side that lies on an edge of a mesh triangle.
inline Role role_with_edge(const SurfaceMesh& mesh, std::int32_t triangle, const TriangleCrossings& crossings,
                           std::int32_t edge) {
  if (edge_of(mesh, triangle, crossings, low_high) == edge) return low_high;
  return edge_of(mesh, triangle, crossings, low_middle) == edge ? low_middle : middle_high;
}

/// The side through which a chord leaves, given the one through which it enters.
inline Role exit_role(const TriangleCrossings& crossings, Role entry, double chord) {
  if (entry != low_high) return low_high;
  return chord < crossings.split ? low_middle : middle_high;
}

/// Crossings keep this share of the edge away from its ends: a streamline never hits a vertex.
inline constexpr double least_position = 1e-9;

inline double clamp_position(double position) {
  return std::clamp(position, least_position, 1 - least_position);
}

/// How far along a side, from its lower end, a chord crosses it.
inline double side_position(const TriangleCrossings& crossings, Role role, double chord) {
  const double from = role == middle_high ? crossings.split : 0;
  const double to = role == low_middle ? crossings.split : 1;
  return clamp_position((chord - from) / (to - from));
}

/// The position along its edge at which a chord crosses a side.
inline double edge_position(const TriangleCrossings& crossings, Role role, double chord) {
  const double along = side_position(crossings, role, chord);
  return crossings.is_reversed(role) ? 1 - along : along;
}

/// Where a chord crosses a side of a mesh triangle.
inline EdgePoint edge_point(const SurfaceMesh& mesh, std::int32_t triangle, const TriangleCrossings& crossings,
                            Role role, double chord) {
  return {edge_of(mesh, triangle, crossings, role), edge_position(crossings, role, chord)};
}

/// The chord that crosses a side at a position along its edge.
inline double chord_coordinate(const TriangleCrossings& crossings, Role role, double edge_position) {
  const double along = crossings.is_reversed(role) ? 1 - edge_position : edge_position;
  const double from = role == middle_high ? crossings.split : 0;
  const double to = role == low_middle ? crossings.split : 1;
  return from + along * (to - from);
}

/// The share of the triangle's area between its low corner and a chord.
inline double area_share(const TriangleCrossings& crossings, double chord) {
  return chord < crossings.split ? chord * chord / crossings.split
                                 : 1 - (1 - chord) * (1 - chord) / (1 - crossings.split);
}

inline double chord_length(const TriangleCrossings& crossings, double chord) {
  return crossings.longest_chord *
         (chord < crossings.split ? chord / crossings.split : (1 - chord) / (1 - crossings.split));
}

}  // namespace pectinate::detail
