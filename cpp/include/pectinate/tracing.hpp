// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "pectinate/orientation_field.hpp"
#include "pectinate/surface_mesh.hpp"

namespace pectinate {

class Occupancy;
namespace detail {
struct Sheet;
}

/// A point on an edge: `position` in (0, 1) from the edge's first end vertex to its second (paper section 2.4).
struct EdgePoint {
  std::int32_t edge;
  double position;
};

/// Where a streamline may start: on an edge, and into which of its triangles first.
struct Seed {
  EdgePoint point;
  std::int32_t triangle;
};

/// Why a streamline ends (paper section 2.6, criteria 1 to 5, and where the field ends).
enum class StopReason : std::uint8_t {
  max_steps,    ///< criterion 1: it crossed `max_steps` triangles in this direction
  boundary,     ///< criterion 2: a border of the surface, or a cut at a non-manifold edge
  near_other,   ///< criterion 3: another streamline is closer than the separation distance
  abrupt_turn,  ///< criterion 4: the field turns by more than `abrupt_turn_angle` across the edge, or makes a U-turn
  /// Criterion 5: a part of it more than 2 d_sep back, or in the same triangle, is closer than d_sep. Of a placed
  /// streamline it may be that the curve of which it is a part came back to itself, and the other part was left out.
  near_itself,
  no_field,     ///< the triangle ahead has no direction
  closed,       ///< it has no end: its last point is its first, bit for bit
  singularity,  ///< the field is singular nearer than `singularity_radius`
};
inline constexpr int stop_reason_count = 8;

struct TracingOptions {
  double separation_distance;  ///< d_sep, unit of the mesh, > 0
  /// d_sep per mesh triangle; replaces `separation_distance` where it is not empty.
  std::vector<double> separation_distances{};
  double abrupt_turn_angle = std::numbers::pi / 2;  ///< radians, in (0, pi]; pi disables criterion 4
  std::int64_t max_steps = 65536;  ///< triangles crossed in each direction, >= 1 (the paper's buffer held 1024)
};

/// A polyline whose points lie on edges and whose segments each cross one triangle.
struct Streamline {
  std::vector<EdgePoint> points;
  std::vector<std::int32_t> triangles;  ///< per segment: one fewer than points
  double length = 0;
  std::int64_t seed_index = 0;               ///< which of `points` is the seed
  std::array<StopReason, 2> stop_reasons{};  ///< at the first and at the last point
};

/// Traces streamlines of one field on one mesh from edge to edge with precomputed crossings (paper section 2.4).
///
/// In a triangle the field is constant, so a streamline crosses it in one straight chord, known by one coordinate
/// across the field. An orientation closer than 1e-9 radians to a side is turned away from it by as much, and a
/// crossing closer than 1e-9 of an edge to its end is moved there: no other approximation is made.
/// Const functions may be called from several threads. Mesh and field must outlive the tracer.
class StreamlineTracer {
 public:
  /// Throws InvalidOption for options out of range, InvalidField for a field of another mesh.
  StreamlineTracer(const SurfaceMesh& mesh, const OrientationField& field, const TracingOptions& options);
  ~StreamlineTracer();

  const TracingOptions& options() const;

  /// Scratch memory of one thread, reused from trace to trace.
  class Workspace;
  struct WorkspaceDeleter {
    void operator()(Workspace* workspace) const;
  };
  static std::unique_ptr<Workspace, WorkspaceDeleter> make_workspace();

  /// The streamline through `seed`, both ways, until a criterion stops it; without `occupancy`, criterion 3 is off.
  /// It may have no segment. The result lives in the workspace until its next use. Throws InvalidField where no
  /// streamline can start.
  const Streamline& trace(const Seed& seed, const Occupancy* occupancy, Workspace& workspace) const;
  /// The same from `start_triangle` of the edge.
  const Streamline& trace(const EdgePoint& seed, const Occupancy* occupancy, Workspace& workspace) const;

  /// A triangle that a streamline from this edge can enter; none if no triangle there has a direction.
  std::optional<std::int32_t> start_triangle(std::int32_t edge) const;

  bool has_direction(std::int32_t triangle) const;
  /// d_sep in a triangle.
  double separation_distance(std::int32_t triangle) const;

  /// For the library's own use.
  const detail::Sheet& sheet() const;

 private:
  struct Precomputed;
  std::unique_ptr<const Precomputed> precomputed_;
};

}  // namespace pectinate
