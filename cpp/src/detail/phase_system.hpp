// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "detail/connection.hpp"
#include "detail/frontal_cholesky.hpp"

namespace pectinate::detail {

/// What is asked of a node's phase.
struct PhaseConstraint {
  Phase target = 0;   ///< unit
  double weight = 0;  ///< 0: nothing; infinite: exactly the target
  bool operator==(const PhaseConstraint&) const = default;
};

/// The linear system for the phase of least Dirichlet energy plus weight / 2 |phi - target|^2 at the constraints.
/// A node that is held exactly keeps its row, but nothing joins it to its neighbours any more, so that the pattern is
/// the same for all constraints.
class PhaseSystem {
 public:
  explicit PhaseSystem(const Connection& connection);

  const PhaseConstraint& constraint(std::int32_t node) const { return constraints_[node]; }
  void constrain(std::int32_t node, const PhaseConstraint& constraint) { constraints_[node] = constraint; }
  /// Adds to a diagonal entry: without any constraint a component may be singular.
  void shift(std::int32_t node, double amount) { shifts_[node] = amount; }

  /// The given nodes and their neighbours: whose rows change with the constraints of the nodes.
  std::vector<std::int32_t> affected(std::span<const std::int32_t> nodes) const;
  /// Brings rows up to date with the constraints and shifts.
  void update(std::span<const std::int32_t> rows);

  const std::vector<FrontalCholesky::Edge>& edges() const { return edges_; }
  const HermitianMatrix& matrix() const { return matrix_; }
  Eigen::VectorXcd& right_hand_side() { return right_hand_side_; }

 private:
  bool held(std::int32_t node) const { return std::isinf(constraints_[node].weight); }

  std::vector<ConnectionEdge> connection_;
  std::vector<FrontalCholesky::Edge> edges_;
  std::vector<std::array<std::int32_t, 3>> edges_of_;  ///< per node, -1: none
  std::vector<PhaseConstraint> constraints_;
  std::vector<double> shifts_;
  HermitianMatrix matrix_;
  Eigen::VectorXcd right_hand_side_;
};

}  // namespace pectinate::detail
