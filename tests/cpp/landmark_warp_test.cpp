// SPDX-License-Identifier: MIT
#include "pectinate/landmark_warp.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "detail/vec.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::test {
namespace {

using detail::vec3;
using detail::vector;
using Points = std::vector<Vec3>;
using Affine = Eigen::Affine3d;

Points random_points(std::size_t count, unsigned seed, double size = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-size, size);
  Points points(count);
  for (Vec3& point : points) point = {number(random), number(random), number(random)};
  return points;
}

Points mapped(const Affine& map, const Points& points) {
  Points result;
  for (const Vec3& point : points) result.push_back(vec3(map * vector(point)));
  return result;
}

/// The points, each moved a little.
Points disturbed(const Points& points, unsigned seed) {
  Points result = points;
  const Points shifts = random_points(points.size(), seed, 0.2);
  for (std::size_t k = 0; k < points.size(); ++k) result[k] = vec3(vector(points[k]) + vector(shifts[k]));
  return result;
}

double greatest_distance(const Points& first, const Points& second) {
  REQUIRE(first.size() == second.size());
  double greatest = 0;
  for (std::size_t k = 0; k < first.size(); ++k) {
    greatest = std::max(greatest, (vector(first[k]) - vector(second[k])).norm());
  }
  return greatest;
}

Affine similarity(double scale) {
  return Eigen::Translation3d(40, -30, 7) * Eigen::AngleAxisd(1.1, detail::Vector(1, 2, -0.5).normalized()) *
         Eigen::Scaling(scale);
}

TEST_CASE("landmark warp: affine maps are reproduced, however stiff") {
  Affine map = similarity(1.3);
  map.linear() += Eigen::Matrix3d{{0, 0.5, 0}, {0, 0.1, -0.2}, {0.3, 0, 0}};
  REQUIRE(map.linear().determinant() > 0);
  const Points landmarks = random_points(9, 1), others = random_points(50, 2, 5);
  for (const double stiffness : {0.0, 0.01, 10.0}) {
    const LandmarkWarp warp = make_landmark_warp(landmarks, mapped(map, landmarks), {stiffness});
    CHECK(greatest_distance(warp_points(warp, others), mapped(map, others)) < 1e-10);
  }
}

TEST_CASE("landmark warp: every landmark goes to its counterpart, less and less so as it grows stiff") {
  const Points from = random_points(30, 3), to = disturbed(from, 4);
  double last = -1;
  for (const double stiffness : {0.0, 0.001, 0.1, 10.0}) {
    const double missed = greatest_distance(warp_points(make_landmark_warp(from, to, {stiffness}), from), to);
    CHECK(missed > last);
    last = missed;
    if (stiffness == 0) CHECK(missed < 1e-10);
  }
}

TEST_CASE("landmark warp: a very stiff one is the affine map of least squares") {
  const Points from = random_points(30, 3), to = disturbed(from, 4);
  Eigen::Matrix<double, 30, 4> rows;
  Eigen::Matrix<double, 30, 3> images;
  for (int k = 0; k < 30; ++k) {
    rows.row(k) << vector(from[k]).transpose(), 1;
    images.row(k) = vector(to[k]).transpose();
  }
  const Eigen::Matrix<double, 4, 3> fit = rows.colPivHouseholderQr().solve(images);
  Affine map = Affine::Identity();
  map.linear() = fit.topRows<3>().transpose();
  map.translation() = fit.row(3).transpose();
  const Points others = random_points(50, 5);
  CHECK(greatest_distance(warp_points(make_landmark_warp(from, to, {1e9}), others), mapped(map, others)) < 1e-7);
}

TEST_CASE("landmark warp: it does not depend on where, how turned and how large either side is, nor on the order") {
  const Points from = random_points(20, 6), to = disturbed(from, 7), others = random_points(50, 8, 2);
  const Affine first = similarity(250), second = similarity(0.01);
  for (const double stiffness : {0.0, 0.05}) {
    const Points expected = mapped(second, warp_points(make_landmark_warp(from, to, {stiffness}), others));
    const auto moved = make_landmark_warp(mapped(first, from), mapped(second, to), {stiffness});
    CHECK(greatest_distance(warp_points(moved, mapped(first, others)), expected) < 1e-11);
    const Points back_from(from.rbegin(), from.rend()), back_to(to.rbegin(), to.rend());
    const auto reversed = make_landmark_warp(back_from, back_to, {stiffness});
    CHECK(greatest_distance(mapped(second, warp_points(reversed, others)), expected) < 1e-12);
  }
}

TEST_CASE("landmark warp: the bending part has no affine part") {
  const Points from = random_points(20, 9);
  const LandmarkWarp warp = make_landmark_warp(from, disturbed(from, 10));
  Eigen::Matrix<double, 3, 4> sum = Eigen::Matrix<double, 3, 4>::Zero();
  double size = 0;
  for (std::size_t k = 0; k < from.size(); ++k) {
    sum.leftCols<3>() += vector(warp.weights[k]) * vector(from[k]).transpose();
    sum.col(3) += vector(warp.weights[k]);
    size += vector(warp.weights[k]).norm();
  }
  CHECK(size > 0.01);
  CHECK(sum.norm() < 1e-12 * size);
}

TEST_CASE("landmark warp: landmarks that make no map are refused") {
  const Points good = random_points(6, 11);
  const auto refused = [](const Points& from, const Points& to, double stiffness = 0) {
    CHECK_THROWS_AS(make_landmark_warp(from, to, {stiffness}), InvalidOption);
  };
  refused({}, {});
  refused({good.begin(), good.begin() + 3}, {good.begin(), good.begin() + 3});
  refused(good, {good.begin(), good.begin() + 5});
  refused(good, good, -1);
  refused(good, good, std::nan(""));
  refused(good, good, std::numeric_limits<double>::infinity());
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300}) {
    Points worse = good;
    worse[2][1] = bad;
    refused(worse, good);
    refused(good, worse);
  }
  Points twice = good;
  twice[4] = twice[1];
  refused(twice, good);
  Points flat = good;
  for (Vec3& point : flat) point[2] = 2 * point[0] - point[1] + 1;
  refused(flat, good);
  refused(good, flat);
  refused(Points(6, Vec3{1, 2, 3}), good);
}

TEST_CASE("landmark warp: a mirror image is refused, and so is one that is also disturbed") {
  const Points from = random_points(12, 12);
  Points to = disturbed(from, 13);
  for (Vec3& point : to) point[0] = -point[0];
  CHECK_THROWS_AS(make_landmark_warp(from, to), InvalidOption);
  CHECK_THROWS_AS(make_landmark_warp(from, to, {1.0}), InvalidOption);
}

TEST_CASE("landmark warp: points that are not finite are not warped") {
  const Points from = random_points(5, 14);
  const LandmarkWarp warp = make_landmark_warp(from, from);
  CHECK_THROWS_AS(warp_points(warp, Points{{0, 0, 0}, {0, std::nan(""), 0}}), InvalidOption);
  CHECK(warp_points(warp, {}).empty());
}

}  // namespace
}  // namespace pectinate::test
