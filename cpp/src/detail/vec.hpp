// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "pectinate/types.hpp"

namespace pectinate::detail {

using Vector = Eigen::Vector3d;

inline Eigen::Map<const Vector> vector(const Vec3& v) {
  return Eigen::Map<const Vector>(v.data());
}
/// Of a value that will be gone, a copy.
inline Vector vector(const Vec3&& v) {
  return {v[0], v[1], v[2]};
}
inline Vec3 vec3(const Vector& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace pectinate::detail
