// SPDX-License-Identifier: MIT
#include "pectinate/orientation_field.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "detail/vec.hpp"
#include "detail/vector_projection.hpp"
#include "pectinate/errors.hpp"

namespace pectinate {
namespace {

using detail::least_share;
using detail::PlanarDirections;
using detail::Vector;
using detail::vector;

struct Direction {
  DirectionStatus status;
  Vector unit = Vector::Zero();
};

using Sides = std::array<Vector, 3>;

Sides sides_of(const SurfaceMesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles()[t];
  const auto at = [&](std::int32_t v) { return vector(mesh.vertices()[v]); };
  return {at(b) - at(a), at(c) - at(b), at(a) - at(c)};
}

struct Plane {
  Sides sides;
  Vector normal;
};

Plane plane_of(const SurfaceMesh& mesh, std::size_t t) {
  return {sides_of(mesh, t), vector(mesh.triangle_normals()[t])};
}

/// The sign of a line is free: this one depends on the triangle's own sides only, so that neither the input's sign
/// nor a rotation of the mesh shows in the result.
Vector with_canonical_sign(const Vector& direction, const Sides& sides) {
  double greatest = 0;
  for (const auto& side : sides) {
    const double product = side.dot(direction);
    if (std::abs(product) > std::abs(greatest)) greatest = product;
  }
  return greatest < 0 ? Vector(-direction) : direction;
}

/// A symmetric tensor in a triangle's plane, spanned by its first side and the direction to the left of it: t_uu - t_vv
/// and 2 t_uv turn twice as fast as its principal direction.
class PlaneTensor {
 public:
  explicit PlaneTensor(const Plane& plane)
      : plane_(plane), along_(plane.sides[0].normalized()), across_(plane.normal.cross(along_)) {}

  void add(const Vec3& line) {
    const Vector unit = (vector(line) / vector(line).cwiseAbs().maxCoeff()).normalized();
    const double u = unit.dot(along_), v = unit.dot(across_);
    difference_ += u * u - v * v;
    shear_ += 2 * u * v;
    trace_ += u * u + v * v;
    size_ += 1;
  }

  void add(const SymmetricTensor& t) {
    Eigen::Matrix3d full;
    full << t[0], t[3], t[5], t[3], t[1], t[4], t[5], t[4], t[2];
    const double scale = full.cwiseAbs().maxCoeff();
    full /= scale;
    const double uu = along_.dot(full * along_), vv = across_.dot(full * across_);
    difference_ += uu - vv;
    shear_ += 2 * along_.dot(full * across_);
    trace_ += std::abs(uu) + std::abs(vv);
    size_ += full.norm();
  }

  Direction principal() const {
    const double magnitude = std::hypot(difference_, shear_);
    if (trace_ <= least_share * size_ && magnitude <= least_share * size_) return {DirectionStatus::normal};
    if (magnitude <= least_share * size_) return {DirectionStatus::isotropic};
    const double angle = std::atan2(shear_, difference_) / 2;
    const Vector unit = std::cos(angle) * along_ + std::sin(angle) * across_;
    return {DirectionStatus::valid, with_canonical_sign(unit, plane_.sides)};
  }

 private:
  const Plane& plane_;
  Vector along_, across_;
  double difference_ = 0, shear_ = 0, trace_ = 0, size_ = 0;
};

DirectionStatus status_of(std::span<const double> numbers) {
  if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); })) {
    return DirectionStatus::non_finite;
  }
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return x == 0; }) ? DirectionStatus::zero
                                                                                      : DirectionStatus::valid;
}

/// The line average of the valid ones among some inputs.
template <class Input>
Direction average(std::span<const Input> inputs, const Plane& plane) {
  PlaneTensor sum(plane);
  auto worst = DirectionStatus::zero;
  bool any = false;
  for (const auto& input : inputs) {
    const auto status = status_of(input);
    if (status == DirectionStatus::valid) {
      sum.add(input);
      any = true;
    } else {
      worst = std::max(worst, status);
    }
  }
  return any ? sum.principal() : Direction{worst};
}

void check_count(std::size_t given, std::size_t expected, const char* per) {
  if (given == expected) return;
  throw InvalidField("the field has " + std::to_string(given) + " rows, but the input mesh has " +
                     std::to_string(expected) + " " + per + "; give one row for each, dropped ones included");
}

template <class Input>
std::array<Input, 3> at_corners(const SurfaceMesh& mesh, std::size_t t, std::span<const Input> per_vertex) {
  const auto& [a, b, c] = mesh.triangles()[t];
  const auto& input = mesh.input_vertex();
  return {per_vertex[input[a]], per_vertex[input[b]], per_vertex[input[c]]};
}

void require_any(const std::vector<DirectionStatus>& status) {
  if (std::ranges::find(status, DirectionStatus::valid) != status.end()) return;
  throw InvalidField(
      "no triangle has a direction: all vectors are zero, not finite or perpendicular to the surface; check which "
      "array "
      "was read");
}

/// What `direct(t, plane)` says of every triangle.
template <class Direct>
PlanarDirections direct_all(const SurfaceMesh& mesh, const Direct& direct) {
  PlanarDirections all;
  all.units.reserve(mesh.triangle_count());
  all.status.reserve(mesh.triangle_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Direction result = direct(t, plane_of(mesh, t));
    all.units.push_back(detail::vec3(result.unit));
    all.status.push_back(result.status);
  }
  all.out_of_plane_angles.resize(mesh.triangle_count(), 0);
  require_any(all.status);
  return all;
}

/// Averages the inputs at the corners of every triangle.
template <class Input>
PlanarDirections average_corners(const SurfaceMesh& mesh, std::span<const Input> inputs) {
  check_count(inputs.size(), mesh.input_vertex_count(), "vertices");
  return direct_all(
      mesh, [&](std::size_t t, const Plane& plane) { return average<Input>(at_corners(mesh, t, inputs), plane); });
}

}  // namespace

OrientationField::OrientationField(std::vector<Vec3> directions, std::vector<DirectionStatus> status,
                                   std::vector<double> out_of_plane_angles)
    : directions_(std::move(directions)),
      status_(std::move(status)),
      out_of_plane_angles_(std::move(out_of_plane_angles)) {}

OrientationField OrientationField::from_triangle_vectors(const SurfaceMesh& mesh, std::span<const Vec3> vectors) {
  check_count(vectors.size(), mesh.input_triangle_count(), "triangles");
  auto [units, status, angles] = detail::project_vectors(mesh, vectors);
  require_any(status);
  return {std::move(units), std::move(status), std::move(angles)};
}

OrientationField OrientationField::from_planar_units(const SurfaceMesh& mesh, std::vector<Vec3> directions) {
  std::vector<DirectionStatus> status(directions.size(), DirectionStatus::zero);
  for (std::size_t t = 0; t < directions.size(); ++t) {
    const Vector unit = vector(directions[t]);
    if (unit.isZero(0)) continue;
    directions[t] = detail::vec3(with_canonical_sign(unit, sides_of(mesh, t)));
    status[t] = DirectionStatus::valid;
  }
  require_any(status);
  std::vector<double> out_of_plane_angles(directions.size(), 0);
  return {std::move(directions), std::move(status), std::move(out_of_plane_angles)};
}

OrientationField OrientationField::from_vertex_vectors(const SurfaceMesh& mesh, std::span<const Vec3> vectors) {
  auto [units, status, angles] = average_corners(mesh, vectors);
  return {std::move(units), std::move(status), std::move(angles)};
}

OrientationField OrientationField::from_triangle_tensors(const SurfaceMesh& mesh,
                                                         std::span<const SymmetricTensor> tensors) {
  check_count(tensors.size(), mesh.input_triangle_count(), "triangles");
  auto [units, status, angles] = direct_all(mesh, [&](std::size_t t, const Plane& plane) {
    return average<SymmetricTensor>({&tensors[mesh.input_triangle()[t]], 1}, plane);
  });
  return {std::move(units), std::move(status), std::move(angles)};
}

OrientationField OrientationField::from_vertex_tensors(const SurfaceMesh& mesh,
                                                       std::span<const SymmetricTensor> tensors) {
  auto [units, status, angles] = average_corners(mesh, tensors);
  return {std::move(units), std::move(status), std::move(angles)};
}

std::size_t OrientationField::count(DirectionStatus status) const {
  return static_cast<std::size_t>(std::count(status_.begin(), status_.end(), status));
}

}  // namespace pectinate
