// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pectinate/surface_mesh.hpp"

namespace pectinate {

/// A weight that means: exactly.
inline constexpr double hard = std::numeric_limits<double>::infinity();
/// Other weights are from `least_weight` to `greatest_weight`: below, rounding tells a field's direction where nothing
/// else acts; above, a weight spoils the equations of its neighbours, which `hard` does not.
inline constexpr double least_weight = 1e-6, greatest_weight = 1e12;

/// A fibre tract as drawn: a polyline in space near the surface (paper section 2.3). Its sense means nothing.
struct Tract {
  std::string name;          ///< for messages; may be empty
  std::vector<Vec3> points;  ///< at least two; the first again at the end closes it
  /// `hard`, or the factor of |phi - exp(2 i theta)|^2 / 2 in the energy, per triangle crossed, in
  /// [`least_weight`, `greatest_weight`]: 1 pulls about as much as one neighbouring triangle.
  double weight = hard;
  std::optional<std::int32_t> number = {};  ///< for messages; by default its index among those given
};

enum class BoundaryRule : std::uint8_t { free, parallel, perpendicular };

/// What fibres do at a boundary loop. Loops without a condition are free (Neumann).
struct BoundaryCondition {
  std::int32_t loop;  ///< index into `mesh.boundary_loops()`
  BoundaryRule rule;
  double weight = hard;  ///< as of a tract
};

struct ConstraintOptions {
  /// A tract point farther than this from the surface is an error; the default is a hundredth of the bounding box's
  /// diagonal. In the unit of the mesh, positive.
  std::optional<double> maximum_distance;
  /// Two demands on one triangle that differ by more, radians in (0, pi/2], are a conflict; below, they are averaged.
  double conflict_angle = 0.5235987755982988;  // 30 degrees
};

/// A tract on the surface: its own points, brought there, and between them the points where the curve crosses edges.
/// Consecutive points lie in one triangle, never closer than 1e-9 of its longest side.
struct ProjectedTract {
  std::vector<Vec3> points;
  std::vector<std::int32_t> triangles;  ///< per segment, the mesh triangle that holds it
  double greatest_distance;             ///< from the tract's given points to the surface
  /// Of the curves between given points, the greatest length over the straight distance. Far above 1.6, the half turn
  /// around a tube, where two points lie on either side of a hole or a cut, or one came to the wrong wall.
  double greatest_detour;
};

/// What a triangle's orientation has to be.
struct TriangleConstraint {
  std::int32_t triangle;  ///< of the mesh
  Vec3 direction;         ///< unit, in the triangle's plane; a line without a sign
  double weight;          ///< `hard`, or the sum of the weights of all that ask for it, at most `greatest_weight`
  std::int32_t tract;     ///< index of the first tract that asks for it, -1 for a boundary condition
};

/// Two demands on one triangle that contradict each other. The first listed tract prevails; any tract over a boundary;
/// of a tract that crosses itself its longest passage in the triangle.
struct ConstraintConflict {
  std::int32_t triangle;
  std::int32_t kept,
      dropped;   ///< indices of tracts, -1 for a boundary condition; equal for a tract that crosses itself
  double angle;  ///< between the two lines, radians
};

struct Constraints {
  std::vector<TriangleConstraint> triangles;  ///< at most one a triangle, ascending
  std::vector<ProjectedTract> tracts;         ///< in the order given
  std::vector<ConstraintConflict> conflicts;  ///< ascending by triangle
};

/// The point of the surface nearest to a point of space.
struct SurfacePoint {
  std::int32_t triangle;
  Vec3 point;
  double distance;
};

/// For each point the nearest one of the surface; of equally near triangles the first. Throws InvalidOption for a point
/// that is not finite or farther away than 1e9 diagonals of the mesh's bounding box.
std::vector<SurfacePoint> nearest_surface_points(const SurfaceMesh& mesh, std::span<const Vec3> points);

/// The boundary loop with the point nearest to `point`. Throws InvalidMesh for a closed surface, InvalidOption for a
/// point that is not finite.
std::int32_t nearest_boundary_loop(const SurfaceMesh& mesh, const Vec3& point);

/// Brings tracts to the surface and collects what they and the boundary ask of each triangle.
///
/// A tract's points go to their nearest points; between two of them the curve is where the surface is cut by the plane
/// through both that is most nearly normal to it. Where that cut does not join them, or takes a detour, a locally
/// shortest path does. Each triangle crossed gets the tangent, averaged as a line over the tract's segments in it,
/// weighted by length. The triangles along a boundary loop get its tangent, smoothed over four edges; one whose sides
/// are all on the loop gets none.
///
/// Demands that differ by at most `conflict_angle` are averaged as lines by their weights; hard ones prevail over
/// weighted ones, and hard tracts over hard boundaries. The sense of a tract means nothing, nor does their order where
/// there is no conflict.
///
/// Throws InvalidOption, naming the tract or the condition, for: fewer than two distinct points; a point that is not
/// finite or too far away; consecutive points on different components; a loop that does not exist or is given twice;
/// a weight out of its range; an option out of its range.
Constraints make_constraints(const SurfaceMesh& mesh, std::span<const Tract> tracts,
                             std::span<const BoundaryCondition> boundary, const ConstraintOptions& options = {});

/// The same for one surface again and again, as in an editor: keeps the search tree for nearest points. Const functions
/// may be called from several threads. The mesh must outlive it.
class TractProjector {
 public:
  explicit TractProjector(const SurfaceMesh& mesh);
  TractProjector(TractProjector&&) noexcept;
  TractProjector& operator=(TractProjector&&) noexcept;
  ~TractProjector();

  std::vector<SurfacePoint> nearest_surface_points(std::span<const Vec3> points) const;
  Constraints make_constraints(std::span<const Tract> tracts, std::span<const BoundaryCondition> boundary,
                               const ConstraintOptions& options = {}) const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

}  // namespace pectinate
