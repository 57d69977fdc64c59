// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

namespace pectinate::detail {

/// A Hermitian matrix whose pattern is a graph: a real diagonal, one complex number per edge.
struct HermitianMatrix {
  std::vector<double> diagonal;
  std::vector<std::complex<double>> edges;  ///< entry (b, a) for the edge {a, b}; entry (a, b) is its conjugate
};

/// Solves sparse positive definite Hermitian systems of one pattern again and again: Cholesky factorization by dense
/// fronts (Duff and Reid, ACM Trans. Math. Softw. 1983) in METIS's order of nested dissection. Fronts keep what they
/// pass on: when parts of a system change, only the fronts from there to the root are done again. That gives what a
/// fresh start would give, to the last bit, and the price hardly depends on how much changes in one place.
class FrontalCholesky {
 public:
  using Edge = std::array<std::int32_t, 2>;

  /// `edges` are pairs of different nodes below `node_count`, each pair once.
  FrontalCholesky(std::int32_t node_count, std::span<const Edge> edges);

  /// Eliminates a system. Throws SolverFailure if the matrix is not positive definite; another system can follow.
  void eliminate(const HermitianMatrix& matrix, const Eigen::VectorXcd& right_hand_side);
  /// The same for a system that differs from the last one in rows of `changed_nodes` only: their diagonal entries and
  /// right hand sides, and edges that have both ends among them.
  void eliminate_again(const HermitianMatrix& matrix, const Eigen::VectorXcd& right_hand_side,
                       std::span<const std::int32_t> changed_nodes);
  /// The same for another right hand side alone.
  void replace(const Eigen::VectorXcd& right_hand_side);

  /// Of the last system, per node; holds until the next call.
  const Eigen::VectorXcd& solution();

 private:
  using Block = Eigen::MatrixXcd;
  /// A complex matrix as two real ones, whose products are nearly twice as fast.
  struct Planes {
    Eigen::MatrixXd real, imaginary;
  };
  /// An entry below the diagonal: its row, and the edge that it comes from, conjugated or not.
  struct Entry {
    std::int32_t row, edge;
    bool conjugated;
  };
  /// Consecutive columns with the same rows below them.
  struct Front {
    std::int32_t first = 0, count = 0;
    std::vector<std::int32_t> rows;       ///< below the columns, ascending
    std::int32_t parent = -1;             ///< -1: none
    std::vector<std::int32_t> in_parent;  ///< of each of the rows, its place in the parent's front
    std::vector<std::int32_t> children;
    bool keeps_contribution = true;
    std::size_t columns_at = 0;  ///< in the factor: (count + rows) x count
    Planes contribution;         ///< to the parent: rows x rows, lower triangle
    Eigen::VectorXcd passed_on;  ///< of the right hand side, to the rows
  };

  void collect_entries(std::span<const Edge> edges);
  using Columns = std::vector<std::vector<std::int32_t>>;
  std::vector<std::int32_t> rows_below(std::int32_t column, const Columns& below,
                                       std::span<const std::int32_t> children);
  void make_fronts(const std::vector<std::int32_t>& parents);
  void link_fronts();
  /// From the given nodes up to the roots, with what was not kept below.
  std::vector<bool> fronts_above(std::span<const std::int32_t> nodes) const;
  Eigen::Map<const Block> columns(const Front& front) const {
    return {factor_.data() + front.columns_at, front.count + static_cast<Eigen::Index>(front.rows.size()), front.count};
  }
  Eigen::Map<Block> columns(const Front& front) {
    return {factor_.data() + front.columns_at, front.count + static_cast<Eigen::Index>(front.rows.size()), front.count};
  }
  void factorize(Front& front, const HermitianMatrix& matrix);
  void assemble(Front& front, const HermitianMatrix& matrix);
  void contribute(Front& front, const Front& child);
  void substitute(Front& front, const Eigen::VectorXcd& right_hand_side);

  std::vector<std::int32_t> place_;    ///< in the order of elimination, per node
  std::vector<std::int32_t> node_;     ///< per place
  std::vector<std::int32_t> offsets_;  ///< per place, of its column's entries
  std::vector<Entry> entries_;
  std::vector<Front> fronts_;           ///< children first
  std::vector<std::int32_t> front_of_;  ///< per place
  /// One after the other, because reading it is what takes time: the columns of all fronts, and the right hand side
  /// after substitution, per place.
  Eigen::VectorXcd factor_, reduced_;
  Eigen::VectorXcd solved_, solution_;  ///< per place, per node
  std::vector<std::int32_t> local_;     ///< scratch space
};

}  // namespace pectinate::detail
