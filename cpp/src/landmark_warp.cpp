// SPDX-License-Identifier: MIT
#include "pectinate/landmark_warp.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>

#include "detail/vec.hpp"
#include "pectinate/errors.hpp"

namespace pectinate {

namespace {

using detail::Vector;
using detail::vector;
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3>;

constexpr std::size_t least_landmarks = 4;
constexpr double flat = 1e-6;        // of the spread, in the thinnest direction
constexpr double coincident = 1e-9;  // of the spread

bool is_finite(const Vec3& point) {
  return std::ranges::all_of(point, [](double x) { return std::isfinite(x); });
}

void check_finite(std::span<const Vec3> points, const std::string& what) {
  const auto bad = std::ranges::find_if_not(points, is_finite);
  if (bad != points.end()) {
    throw InvalidOption(what + " " + std::to_string(bad - points.begin()) + " is not finite; give three numbers");
  }
}

/// Landmarks around their centroid, in units of their spread.
struct Cloud {
  Points points;
  Vector centre;
  double spread;  ///< root mean square distance from the centroid
};

/// Throws InvalidOption for landmarks in one plane.
Cloud make_cloud(std::span<const Vec3> landmarks, const std::string& side) {
  Cloud cloud{Points(landmarks.size(), 3), Vector::Zero(), 0};
  for (std::size_t k = 0; k < landmarks.size(); ++k) cloud.points.row(k) = vector(landmarks[k]);
  cloud.centre = cloud.points.colwise().mean();
  cloud.points.rowwise() -= cloud.centre.transpose();
  cloud.spread = cloud.points.stableNorm() / std::sqrt(static_cast<double>(landmarks.size()));
  if (cloud.spread > 0) cloud.points /= cloud.spread;
  const Eigen::JacobiSVD<Points> shape(cloud.points);
  const bool is_solid = std::isfinite(cloud.spread) && shape.singularValues()(2) > flat * shape.singularValues()(0);
  if (!is_solid) {
    throw InvalidOption("the landmarks " + side + " lie in one plane or are too far apart; give four that do not");
  }
  return cloud;
}

void check_distinct(const Points& points) {
  std::vector<Eigen::Index> order(points.rows());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](Eigen::Index k) { return points(k, 0); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const Vector apart = points.row(order[j]) - points.row(order[i]);
      if (apart.x() > coincident) break;
      if (apart.norm() > coincident) continue;
      const auto [first, second] = std::minmax(order[i], order[j]);
      throw InvalidOption("landmarks " + std::to_string(first) + " and " + std::to_string(second) +
                          " are in one place; leave one out");
    }
  }
}

/// The spline's equations: what bends has no part that an affine map could do.
Eigen::MatrixXd equations(const Points& from, double stiffness) {
  const Eigen::Index count = from.rows();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count + 4, count + 4);
  for (Eigen::Index k = 0; k < count; ++k) {
    matrix.col(k).head(count) = (from.rowwise() - from.row(k)).rowwise().norm();
  }
  // The distance is negative definite on such weights, hence the sign.
  matrix.diagonal().head(count).array() -= stiffness * static_cast<double>(count);
  matrix.block(0, count, count, 3) = from;
  matrix.col(count + 3).head(count).setOnes();
  matrix.bottomLeftCorner(4, count) = matrix.topRightCorner(count, 4).transpose();
  return matrix;
}

void check_not_mirrored(const Eigen::Matrix3d& linear) {
  if (linear.determinant() > 0) return;
  throw InvalidOption(
      "the landmarks turn space inside out, as if in a mirror; names of left and right, or of two landmarks, are "
      "probably exchanged");
}

}  // namespace

LandmarkWarp make_landmark_warp(std::span<const Vec3> from, std::span<const Vec3> to, const WarpOptions& options) {
  if (from.size() != to.size()) {
    throw InvalidOption("there are " + std::to_string(from.size()) + " landmarks, but " + std::to_string(to.size()) +
                        " counterparts; give one each");
  }
  if (from.size() < least_landmarks) {
    throw InvalidOption(std::to_string(from.size()) + " landmarks are too few; give at least four");
  }
  if (!(options.stiffness >= 0 && std::isfinite(options.stiffness))) {
    throw InvalidOption("stiffness is " + std::to_string(options.stiffness) + ", but must be finite, not negative");
  }
  check_finite(from, "landmark");
  check_finite(to, "the counterpart of landmark");
  const Cloud source = make_cloud(from, "to map from"), target = make_cloud(to, "to map to");
  check_distinct(source.points);

  const Eigen::Index count = source.points.rows();
  Points values = Points::Zero(count + 4, 3);
  values.topRows(count) = target.points;
  const Points solution = equations(source.points, options.stiffness).partialPivLu().solve(values);
  const Eigen::Matrix3d linear = solution.middleRows(count, 3).transpose() * (target.spread / source.spread);
  check_not_mirrored(linear);
  const Vector offset = target.centre + target.spread * solution.row(count + 3).transpose() - linear * source.centre;

  LandmarkWarp warp{{from.begin(), from.end()}, {}, {}, detail::vec3(offset)};
  for (int k = 0; k < 3; ++k) warp.linear[k] = detail::vec3(linear.row(k));
  warp.weights.reserve(from.size());
  for (Eigen::Index k = 0; k < count; ++k) {
    warp.weights.push_back(detail::vec3(solution.row(k) * (target.spread / source.spread)));
  }
  return warp;
}

std::vector<Vec3> warp_points(const LandmarkWarp& warp, std::span<const Vec3> points) {
  check_finite(points, "point");
  Eigen::Matrix3d linear;
  for (int k = 0; k < 3; ++k) linear.row(k) = vector(warp.linear[k]);
  std::vector<Vec3> moved;
  moved.reserve(points.size());
  for (const Vec3& point : points) {
    Vector image = linear * vector(point) + vector(warp.offset);
    for (std::size_t k = 0; k < warp.landmarks.size(); ++k) {
      image += (vector(point) - vector(warp.landmarks[k])).norm() * vector(warp.weights[k]);
    }
    moved.push_back(detail::vec3(image));
  }
  return moved;
}

}  // namespace pectinate
