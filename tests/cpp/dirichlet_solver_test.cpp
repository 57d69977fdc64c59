// SPDX-License-Identifier: MIT
#include "detail/dirichlet_solver.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <limits>

#include "detail/random.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::test {
namespace {

/// Rows that sum to zero or a little more, positive on the diagonal only, of symmetric pattern.
Eigen::MatrixXd random_m_matrix(int size, Random& random) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i < size; ++i) {
    for (const int j : {(i + 1) % size, (i + size - 1) % size, (i * i + 3) % size}) {
      if (i == j) continue;
      matrix(i, j) = -std::pow(10, 6 * random.unit() - 3);
      matrix(j, i) = -std::pow(10, 6 * random.unit() - 3);
    }
  }
  for (int i = 0; i < size; ++i) matrix(i, i) = -matrix.row(i).sum();
  return matrix;
}

}  // namespace

TEST_CASE("dirichlet solver: agrees with a dense solver, for every right-hand side") {
  Random random(1);
  for (const int size : {4, 17, 60}) {
    const Eigen::MatrixXd matrix = random_m_matrix(size, random);
    std::vector<bool> fixed(size, false);
    Eigen::MatrixXd dense = matrix;
    for (int i = 0; i < size; i += 5) {
      fixed[i] = true;
      dense.row(i) = Eigen::RowVectorXd::Unit(size, i);
    }
    const detail::DirichletSolver solver(matrix.sparseView(), fixed);
    for (int repeat = 0; repeat < 3; ++repeat) {
      Eigen::VectorXd given(size);
      for (auto& x : given) x = 2 * random.unit() - 1;
      const Eigen::VectorXd expected = dense.fullPivLu().solve(given);
      CHECK((solver.solve(given) - expected).norm() < 1e-9 * expected.norm());
    }
  }
}

TEST_CASE("dirichlet solver: nothing free, and what cannot be solved") {
  const Eigen::SparseMatrix<double> identity = Eigen::MatrixXd::Identity(3, 3).sparseView();
  const Eigen::VectorXd given = Eigen::Vector3d(1, 2, 3);
  CHECK(detail::DirichletSolver(identity, {true, true, true}).solve(given) == given);
  const Eigen::SparseMatrix<double> singular = Eigen::Matrix3d(Eigen::Vector3d(1, 0, 1).asDiagonal()).sparseView();
  CHECK_THROWS_AS(detail::DirichletSolver(singular, {false, false, false}), SolverFailure);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    CHECK_THROWS_AS(detail::DirichletSolver(bad * identity, {false, false, false}), SolverFailure);
    CHECK_THROWS_AS(detail::DirichletSolver(identity, {false, false, true}).solve(bad * given), SolverFailure);
  }
}

}  // namespace pectinate::test
