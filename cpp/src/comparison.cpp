// SPDX-License-Identifier: MIT
#include "pectinate/comparison.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "detail/field_of_directions.hpp"
#include "detail/fit_checks.hpp"
#include "detail/number_text.hpp"
#include "detail/random.hpp"
#include "detail/vec.hpp"
#include "pectinate/errors.hpp"

namespace pectinate {
namespace {

using detail::Vector;
using detail::vector;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
/// Principal values that differ by less, relatively, prefer no direction.
constexpr double least_preference = 1e-9;

/// By Box and Muller, from two draws whatever they are.
double standard_normal(Random& random) {
  const double radius = std::sqrt(-2 * std::log(1 - random.unit()));
  return radius * std::cos(2 * std::numbers::pi * random.unit());
}

/// The sum of area v v^T over some triangles.
struct LineSum {
  Eigen::Matrix3d tensor = Eigen::Matrix3d::Zero();
  Vector first = Vector::Zero();  ///< the first line, which settles the sign

  void add(const Vector& line, double area) {
    if (first.isZero(0)) first = line;
    tensor += area * line * line.transpose();
  }

  Vec3 principal() const {
    if (first.isZero(0)) return {0, 0, 0};
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(tensor);
    const auto& values = solver.eigenvalues();
    if (!(values[2] - values[1] > least_preference * values[2])) return {0, 0, 0};
    const Vector direction = solver.eigenvectors().col(2).normalized();
    return detail::vec3(direction.dot(first) < 0 ? Vector(-direction) : direction);
  }
};

}  // namespace

std::vector<double> angles_between(const OrientationField& first, const OrientationField& second) {
  const std::size_t count = first.directions().size();
  if (second.directions().size() != count) {
    throw InvalidField("the first field is for " + std::to_string(count) + " triangles, the second for " +
                       std::to_string(second.directions().size()) +
                       "; compare fields of one mesh, or transfer one of them first");
  }
  std::vector<double> angles(count, nan);
  for (std::size_t t = 0; t < count; ++t) {
    const auto triangle = static_cast<std::int32_t>(t);
    if (!first.has_direction(triangle) || !second.has_direction(triangle)) continue;
    const auto a = vector(first.directions()[t]), b = vector(second.directions()[t]);
    angles[t] = std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
  }
  return angles;
}

OrientationField add_angular_noise(const SurfaceMesh& mesh, const OrientationField& field, double standard_deviation,
                                   std::uint64_t random_seed) {
  detail::check_is_on(mesh, field);
  if (!(standard_deviation >= 0 && standard_deviation <= std::numbers::pi)) {
    throw InvalidOption("standard_deviation is " + detail::number_text(standard_deviation) +
                        ", but must be an angle from 0 to pi, in radians");
  }
  if (standard_deviation == 0) return field;
  Random random(random_seed);
  std::vector<Vec3> directions(mesh.triangle_count());
  for (std::size_t t = 0; t < directions.size(); ++t) {
    const double angle = standard_deviation * standard_normal(random);
    const auto direction = vector(field.directions()[t]);
    const Vector across = vector(mesh.triangle_normals()[t]).cross(direction);
    directions[t] = detail::vec3(std::cos(angle) * direction + std::sin(angle) * across);
  }
  return detail::field_of_directions(mesh, directions);
}

std::vector<Vec3> vertex_directions(const SurfaceMesh& mesh, const OrientationField& field) {
  detail::check_is_on(mesh, field);
  std::vector<LineSum> sums(mesh.vertices().size());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (!field.has_direction(static_cast<std::int32_t>(t))) continue;
    for (const auto v : mesh.triangles()[t]) sums[v].add(vector(field.directions()[t]), mesh.triangle_areas()[t]);
  }
  std::vector<Vec3> directions;
  directions.reserve(sums.size());
  for (const auto& sum : sums) directions.push_back(sum.principal());
  return directions;
}

}  // namespace pectinate
