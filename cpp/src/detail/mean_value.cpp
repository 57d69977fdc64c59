// SPDX-License-Identifier: MIT
#include "detail/mean_value.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace pectinate::detail {
namespace {

/// Angles of nearly 0 or pi, as fans over slits have them, would ask for weights of 0 or infinity.
constexpr double least_tangent = 1e-3, greatest_tangent = 1e3;
/// The centre of a fan may fall on a vertex of its loop.
constexpr double least_length_ratio = 1e-6;

double half_angle_tangent(const Vector& u, const Vector& v) {
  const double sine = u.cross(v).norm(), one_plus_cosine = u.norm() * v.norm() + u.dot(v);
  if (sine >= greatest_tangent * one_plus_cosine) return greatest_tangent;
  return std::max(sine / one_plus_cosine, least_tangent);
}

}  // namespace

double mean_value_share(const Vector& spoke, const Vector& other) {
  return half_angle_tangent(spoke, other) / std::max(spoke.norm(), least_length_ratio * other.norm());
}

Eigen::SparseMatrix<double> mean_value_matrix(const std::vector<Vec3>& vertices,
                                              const std::vector<Triangle>& triangles) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(12 * triangles.size());
  const auto add = [&](std::int32_t i, std::int32_t j, double weight) {
    entries.emplace_back(i, j, -weight);
    entries.emplace_back(i, i, weight);
  };
  for (const auto& corners : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto i = corners[k], next = corners[(k + 1) % 3], last = corners[(k + 2) % 3];
      const Vector to_next = vector(vertices[next]) - vector(vertices[i]);
      const Vector to_last = vector(vertices[last]) - vector(vertices[i]);
      add(i, next, mean_value_share(to_next, to_last));
      add(i, last, mean_value_share(to_last, to_next));
    }
  }
  const auto size = static_cast<Eigen::Index>(vertices.size());
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace pectinate::detail
