// SPDX-License-Identifier: MIT
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "detail/disk_locator.hpp"
#include "detail/field_of_directions.hpp"
#include "detail/fit_checks.hpp"
#include "detail/mesh_geometry.hpp"
#include "detail/number_text.hpp"
#include "pectinate/comparison.hpp"
#include "pectinate/constraints.hpp"
#include "pectinate/errors.hpp"

namespace pectinate {
namespace {

using detail::cross;
using detail::Vector;
using detail::vector;
using Eigen::Vector2d;
using LoopPairs = std::vector<std::array<std::int32_t, 2>>;

/// The holes' centres fix no rotation if they, weighted by their distance from the middle, agree on less.
constexpr double least_agreement = 1e-9;
constexpr double greatest_radius = 1 + 1e-9;

/// Where a target triangle's direction comes from, if anywhere.
struct Counterpart {
  std::int32_t triangle = -1;
  double distance = std::numeric_limits<double>::quiet_NaN();
  Vec3 direction{0, 0, 0};  ///< of any length
};

Vector centre(const SurfaceMesh& mesh, std::int32_t triangle) {
  const auto [a, b, c] = detail::corners(mesh, triangle);
  return (a + b + c) / 3;
}

/// What `find(triangle)` gives every target triangle.
template <class Find>
Transfer transfer(const SurfaceMesh& target, const Find& find) {
  std::vector<Vec3> directions;
  std::vector<std::int32_t> source_triangles;
  std::vector<double> distances;
  for (std::size_t t = 0; t < target.triangle_count(); ++t) {
    const Counterpart counterpart = find(static_cast<std::int32_t>(t));
    directions.push_back(counterpart.direction);
    source_triangles.push_back(counterpart.triangle);
    distances.push_back(counterpart.distance);
  }
  if (std::none_of(directions.begin(), directions.end(), [](const Vec3& d) { return !vector(d).isZero(0); })) {
    throw InvalidField(
        "no triangle of the target has a counterpart with a direction; check that both surfaces are in one place and "
        "unit, or take a greater maximum_distance");
  }
  return {detail::field_of_directions(target, directions), std::move(source_triangles), std::move(distances)};
}

/// A direction in the plane of normal `from`, turned with it to the plane of normal `to` about the line in both.
Vector turned(const Vector& direction, const Vector& from, Vector to) {
  if (from.dot(to) < 0) to = -to;  // planes, whichever way their surfaces are wound
  return direction - direction.dot(to) / (1 + from.dot(to)) * (from + to);
}

void check_disk(const SurfaceMesh& mesh, const Parameterization& disk, const std::string& name) {
  if (!detail::is_of(disk, mesh)) {
    throw InvalidOption("the " + name + "'s parameterization is not of its mesh: it has other vertices or loops");
  }
  for (std::size_t v = 0; v < disk.points.size(); ++v) {
    const auto& [x, y] = disk.points[v];
    const bool is_inside = std::hypot(x, y) <= greatest_radius, is_missing = std::isnan(x) && std::isnan(y);
    if (!is_inside && !is_missing) {
      throw InvalidOption("vertex " + std::to_string(v) + " of the " + name + "'s parameterization is not in the disk");
    }
  }
}

/// The image of a loop's hole.
Vector2d hole_centre(const Parameterization& disk, std::int32_t loop, const std::string& name) {
  const auto loop_name = name + " loop " + std::to_string(loop) + " of loop_pairs";
  const auto loop_count = static_cast<std::int32_t>(disk.loop_centres.size());
  if (loop < 0 || loop >= loop_count) {
    throw InvalidOption(loop_name + " does not exist; the surface has boundary loops 0 to " +
                        std::to_string(loop_count - 1));
  }
  const auto& [x, y] = disk.loop_centres[loop];
  if (!(std::hypot(x, y) <= greatest_radius)) {
    throw InvalidOption(loop_name + " bounds a fragment that has no place in the disk; choose another one");
  }
  return {x, y};
}

void check_pairs(const LoopPairs& pairs, const Parameterization& source_disk, const Parameterization& target_disk) {
  std::set<std::int32_t> sources, targets;
  std::size_t inner_count = 0;
  for (const auto& [source, target] : pairs) {
    const auto name = "the pair " + std::to_string(source) + ", " + std::to_string(target) + " of loop_pairs";
    if (!sources.insert(source).second || !targets.insert(target).second) {
      throw InvalidOption(name + " has a loop that is given twice; pair each at most once");
    }
    if ((source == source_disk.outer_loop) != (target == target_disk.outer_loop)) {
      throw InvalidOption(name + " is of an outer loop and an inner one; the outer loops belong together");
    }
    inner_count += source == source_disk.outer_loop ? 0 : 1;
  }
  if (inner_count == 0) throw InvalidOption("loop_pairs has no pair of inner loops; give at least one");
}

/// The rotation of the disk of the source that brings its holes nearest to those of the target (Procrustes).
Eigen::Matrix2d alignment(const Parameterization& source_disk, const Parameterization& target_disk,
                          const LoopPairs& pairs) {
  check_pairs(pairs, source_disk, target_disk);
  double cosine = 0, sine = 0;
  for (const auto& [source, target] : pairs) {
    const Vector2d from = hole_centre(source_disk, source, "source"), to = hole_centre(target_disk, target, "target");
    cosine += from.dot(to);
    sine += cross(from, to);
  }
  const double agreement = std::hypot(cosine, sine);
  if (!(agreement > least_agreement)) {
    throw InvalidOption(
        "loop_pairs fixes no rotation of the disk: its holes are in the middle or contradict each other; add a pair");
  }
  Eigen::Matrix2d rotation;
  rotation << cosine, -sine, sine, cosine;
  return rotation / agreement;
}

/// The sides from a triangle's first corner, on the surface and in the disk, a side per column.
struct TriangleSides {
  Eigen::Matrix<double, 3, 2> surface;
  Eigen::Matrix2d disk;
  Vector normal;

  TriangleSides(const SurfaceMesh& mesh, const detail::DiskTriangle& triangle)
      : normal(vector(mesh.triangle_normals()[triangle.index])) {
    const auto corners = detail::corners(mesh, triangle.index);
    surface << corners[1] - corners[0], corners[2] - corners[0];
    disk << triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0];
  }

  /// The differential of the map and its inverse, up to a positive factor.
  Vector2d to_disk(const Vector& v) const {
    return disk * Vector2d(normal.dot(v.cross(surface.col(1))), normal.dot(surface.col(0).cross(v)));
  }
  Vector from_disk(const Vector2d& v) const { return surface * Vector2d(cross(v, disk.col(1)), cross(disk.col(0), v)); }
};

}  // namespace

Transfer transfer_by_nearest_point(const SurfaceMesh& source, const OrientationField& field, const SurfaceMesh& target,
                                   double maximum_distance) {
  detail::check_is_on(source, field);
  if (!(maximum_distance > 0)) {
    throw InvalidOption("maximum_distance is " + detail::number_text(maximum_distance) +
                        ", but must be positive; infinity sets no limit");
  }
  std::vector<Vec3> centres;
  centres.reserve(target.triangle_count());
  for (std::size_t t = 0; t < target.triangle_count(); ++t) {
    centres.push_back(detail::vec3(centre(target, static_cast<std::int32_t>(t))));
  }
  const auto nearest = nearest_surface_points(source, centres);
  return transfer(target, [&](std::int32_t t) -> Counterpart {
    const auto& [triangle, point, distance] = nearest[t];
    if (distance > maximum_distance) return {};
    const Vector direction = turned(vector(field.directions()[triangle]), vector(source.triangle_normals()[triangle]),
                                    vector(target.triangle_normals()[t]));
    return {triangle, distance, detail::vec3(direction)};
  });
}

Transfer transfer_through_disks(const SurfaceMesh& source, const Parameterization& source_disk,
                                const OrientationField& field, const SurfaceMesh& target,
                                const Parameterization& target_disk, const LoopPairs& loop_pairs) {
  detail::check_is_on(source, field);
  check_disk(source, source_disk, "source");
  check_disk(target, target_disk, "target");
  const Eigen::Matrix2d rotation = alignment(source_disk, target_disk, loop_pairs);
  const detail::DiskLocator locator(source, source_disk.points);
  return transfer(target, [&](std::int32_t t) -> Counterpart {
    const auto image = detail::disk_triangle(target, target_disk.points, t);
    if (!image) return {};
    const auto& [a, b, c] = image->corners;
    const auto place = locator.find(rotation.transpose() * (a + b + c) / 3);
    if (!place) return {};
    const auto corners = detail::corners(source, place->triangle);
    const Vector point =
        place->weights[0] * corners[0] + place->weights[1] * corners[1] + place->weights[2] * corners[2];
    const TriangleSides from(source, *detail::disk_triangle(source, source_disk.points, place->triangle));
    const Vector2d in_disk = rotation * from.to_disk(vector(field.directions()[place->triangle]));
    return {place->triangle, (point - centre(target, t)).norm(),
            detail::vec3(TriangleSides(target, *image).from_disk(in_disk))};
  });
}

}  // namespace pectinate
