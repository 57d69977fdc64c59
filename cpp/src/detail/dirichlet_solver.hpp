// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

namespace pectinate::detail {

/// A linear system in which the values of some unknowns are given; factorized once, for many right-hand sides.
///
/// For matrices of symmetric pattern that need no pivoting, such as convex combinations of neighbours: the free
/// unknowns are ordered by approximate minimum degree and pivots stay on the diagonal.
class DirichletSolver {
 public:
  /// Rows of fixed unknowns are not looked at. Throws SolverFailure for a matrix that is singular or not finite.
  DirichletSolver(const Eigen::SparseMatrix<double>& matrix, const std::vector<bool>& fixed);
  DirichletSolver(DirichletSolver&&) noexcept;
  DirichletSolver& operator=(DirichletSolver&&) noexcept;
  ~DirichletSolver();

  /// `given` holds the values of fixed unknowns and the right-hand sides of free ones. Throws SolverFailure.
  Eigen::VectorXd solve(const Eigen::VectorXd& given) const;

 private:
  struct Factorization;
  std::unique_ptr<Factorization> factorization_;
};

}  // namespace pectinate::detail
