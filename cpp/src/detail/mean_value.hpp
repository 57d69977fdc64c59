// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "detail/vec.hpp"

namespace pectinate::detail {

/// What a triangle adds to the mean value weight of a neighbour: tan(angle / 2) / |spoke|, of the two sides `spoke`
/// (to the neighbour) and `other` that leave a vertex, and of the angle between them (Floater, Comput. Aided Geom. Des.
/// 2003). Always positive: the tangent is kept within [1e-3, 1e3], and a spoke counts as at least 1e-6 of the other.
double mean_value_share(const Vector& spoke, const Vector& other);

/// Row i: the sum over neighbours j of w_ij (x_i - x_j), with mean value weights at interior vertices i.
Eigen::SparseMatrix<double> mean_value_matrix(const std::vector<Vec3>& vertices,
                                              const std::vector<Triangle>& triangles);

}  // namespace pectinate::detail
