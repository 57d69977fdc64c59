// SPDX-License-Identifier: MIT
#include "detail/dirichlet_solver.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseLU>
#include <cmath>
#include <utility>

#include "pectinate/errors.hpp"

namespace pectinate::detail {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Permutation = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;

constexpr int fixed_unknown = -1;

/// Place of every unknown among the free ones, or `fixed_unknown`.
std::vector<int> number_free(const std::vector<bool>& fixed) {
  std::vector<int> number(fixed.size(), fixed_unknown);
  int count = 0;
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (!fixed[i]) number[i] = count++;
  }
  return number;
}

}  // namespace

struct DirichletSolver::Factorization {
  std::vector<int> number;  ///< per unknown
  Matrix coupling;          ///< rows of free unknowns, columns of all, zero in those of free ones
  Permutation order;
  Eigen::SparseLU<Matrix, Eigen::NaturalOrdering<int>> lower_upper;
};

DirichletSolver::DirichletSolver(const Matrix& matrix, const std::vector<bool>& fixed)
    : factorization_(std::make_unique<Factorization>()) {
  auto& [number, coupling, order, lower_upper] = *factorization_;
  number = number_free(fixed);
  std::vector<Eigen::Triplet<double>> among_free, with_fixed;
  int free_count = 0;
  for (int column = 0; column < matrix.cols(); ++column) {
    free_count += number[column] != fixed_unknown;
    for (Matrix::InnerIterator entry(matrix, column); entry; ++entry) {
      const int row = number[entry.row()];
      if (row == fixed_unknown) continue;
      if (!std::isfinite(entry.value())) throw SolverFailure("a coefficient of the linear system is not finite");
      if (number[column] == fixed_unknown) {
        with_fixed.emplace_back(row, column, entry.value());
      } else {
        among_free.emplace_back(row, number[column], entry.value());
      }
    }
  }
  coupling = Matrix(free_count, matrix.cols());
  coupling.setFromTriplets(with_fixed.begin(), with_fixed.end());
  if (free_count == 0) return;
  Matrix system(free_count, free_count), ordered;
  system.setFromTriplets(among_free.begin(), among_free.end());
  Eigen::AMDOrdering<int>()(system, order);
  ordered = system.twistedBy(order.inverse());
  lower_upper.setPivotThreshold(0);
  lower_upper.compute(ordered);
  if (lower_upper.info() != Eigen::Success) throw SolverFailure("the linear system is singular");
}

DirichletSolver::DirichletSolver(DirichletSolver&&) noexcept = default;
DirichletSolver& DirichletSolver::operator=(DirichletSolver&&) noexcept = default;
DirichletSolver::~DirichletSolver() = default;

Eigen::VectorXd DirichletSolver::solve(const Eigen::VectorXd& given) const {
  const auto& [number, coupling, order, lower_upper] = *factorization_;
  Eigen::VectorXd solution = given;
  if (coupling.rows() == 0) return solution;
  Eigen::VectorXd right_side = -(coupling * given);
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] != fixed_unknown) right_side[number[i]] += given[static_cast<Eigen::Index>(i)];
  }
  const Eigen::VectorXd ordered = order.inverse() * right_side;
  const Eigen::VectorXd free = order * Eigen::VectorXd(lower_upper.solve(ordered));
  if (!free.allFinite()) throw SolverFailure("the solution of the linear system is not finite");
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] != fixed_unknown) solution[static_cast<Eigen::Index>(i)] = free[number[i]];
  }
  return solution;
}

}  // namespace pectinate::detail
