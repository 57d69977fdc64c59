// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "pectinate/orientation_field.hpp"
#include "pectinate/surface_mesh.hpp"
#include "pectinate/tracing.hpp"

namespace pectinate::detail {

/// A side's part in the chords of its triangle. Across the field the three corners lie in the order low, middle, high:
/// every chord crosses the side low-high and one of the others.
enum Role : std::int8_t { low_high = 0, low_middle = 1, middle_high = 2 };

/// What lies beyond a side.
struct Exit {
  std::int32_t edge;
  std::int32_t triangle;   ///< -1 where streamlines stop
  Role role;               ///< of this side in that triangle
  StopReason stop_reason;  ///< where there is no triangle to go on to
  bool reversed;           ///< the chord coordinate runs against the edge
};

/// A triangle's precomputed crossings (paper section 2.4). A chord has the coordinate s in (0, 1) at which it crosses
/// the side low-high; it leaves through low-middle where s < split, through middle-high where s > split. `split` is
/// the paper's critical coordinate s_c of that side.
struct TriangleCrossings {
  double split = 0;
  double longest_chord = 0;     ///< through the middle corner
  double width = 0;             ///< across the field, from the low corner to the high one
  std::array<Exit, 3> exits{};  ///< by Role
  std::int32_t middle = 0;      ///< the corner that the side low-high misses
};

/// Crossings of all triangles; those of triangles without a direction are meaningless.
std::vector<TriangleCrossings> make_crossings(const SurfaceMesh& mesh, const OrientationField& field,
                                              double abrupt_turn_angle);

/// The part of triangle side `side` in the chords, given the corner that lies in the middle.
inline Role role_of(int side, int middle) {
  return std::array{low_middle, low_high, middle_high}[(side - middle + 3) % 3];
}

/// The side that lies on an edge of the triangle.
inline Role role_with_edge(const TriangleCrossings& crossings, std::int32_t edge) {
  if (crossings.exits[low_high].edge == edge) return low_high;
  return crossings.exits[low_middle].edge == edge ? low_middle : middle_high;
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

/// The position along its edge at which a chord crosses a side.
inline double edge_position(const TriangleCrossings& crossings, Role role, double chord) {
  double along = chord;
  if (role == low_middle) along = chord / crossings.split;
  if (role == middle_high) along = (chord - crossings.split) / (1 - crossings.split);
  return clamp_position(crossings.exits[role].reversed ? 1 - along : along);
}

/// The chord that crosses a side at a position along its edge.
inline double chord_coordinate(const TriangleCrossings& crossings, Role role, double edge_position) {
  const double along = crossings.exits[role].reversed ? 1 - edge_position : edge_position;
  if (role == low_middle) return along * crossings.split;
  if (role == middle_high) return crossings.split + along * (1 - crossings.split);
  return along;
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
