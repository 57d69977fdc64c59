// SPDX-License-Identifier: MIT
#include "pectinate/smoothing.hpp"

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "detail/connection.hpp"
#include "detail/field_of_directions.hpp"
#include "pectinate/errors.hpp"

namespace pectinate {
namespace {

using detail::Phase;
using detail::vector;
using Phases = Eigen::VectorXcd;
using Matrix = Eigen::SparseMatrix<Phase>;

/// Of the residual, in each solve.
constexpr double solver_tolerance = 1e-9;
/// Weights have settled when none changes by more than this from one solve to the next, as a share of 1.
constexpr double weight_tolerance = 1e-3;

void check(const SurfaceMesh& mesh, const OrientationField& field, const SmoothingOptions& options,
           std::span<const std::int32_t> barriers) {
  const auto reject = [](const std::string& rule) { throw InvalidOption(rule); };
  if (!(options.length > 0) || !std::isfinite(options.length)) {
    reject("length = " + std::to_string(options.length) + " is not a positive length; give one, such as 1.5 mm");
  }
  if (!(options.outlier_angle > 0 && options.outlier_angle <= std::numbers::pi / 2)) {
    reject("outlier_angle = " + std::to_string(options.outlier_angle) + " is out of range; give radians in (0, pi/2]");
  }
  if (options.max_iterations < 1 || options.max_iterations > 1000) {
    reject("max_iterations = " + std::to_string(options.max_iterations) + " is out of range; give 1 to 1000");
  }
  if (!barriers.empty() && barriers.size() != mesh.triangle_count()) {
    reject("there are " + std::to_string(barriers.size()) + " barrier labels, but the mesh has " +
           std::to_string(mesh.triangle_count()) + " triangles; give one for each");
  }
  if (field.directions().size() != mesh.triangle_count()) {
    throw InvalidField("the field has " + std::to_string(field.directions().size()) + " triangles, but the mesh has " +
                       std::to_string(mesh.triangle_count()) + "; give the field of this mesh");
  }
}

/// The weighted least squares problem whose weights are adapted until its solution is the robust one.
class RobustProblem {
 public:
  RobustProblem(const SurfaceMesh& mesh, const OrientationField& field, const SmoothingOptions& options,
                std::span<const std::int32_t> barriers)
      : connection_(detail::make_connection(mesh)),
        threshold_(2 * std::sin(options.outlier_angle)),
        measured_(Phases::Zero(connection_.node_count)),
        areas_(Eigen::VectorXd::Zero(connection_.node_count)) {
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
      const auto triangle = static_cast<std::int32_t>(t);
      if (!field.has_direction(triangle)) continue;
      const Phase z = detail::phase_of(vector(field.directions()[t]), detail::triangle_frame(mesh, triangle));
      set(triangle, z, mesh.triangle_areas()[t]);
      if (connection_.back[t] >= 0) set(connection_.back[t], std::conj(z), mesh.triangle_areas()[t]);
    }
    make_matrix(options.length * options.length / 2, barriers);
    smooth_ = measured_;
    weights_ = areas_;
  }

  /// Solves with the present weights and adapts them; whether they have settled.
  bool step() {
    Matrix matrix = coupling_;
    for (Eigen::Index node = 0; node < weights_.size(); ++node) {
      matrix.valuePtr()[diagonal_[node]] += weights_[node];
    }
    Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> solver(matrix);
    solver.setTolerance(solver_tolerance);
    smooth_ = solver.solveWithGuess((weights_.array() * measured_.array()).matrix(), smooth_);
    double greatest_change = 0;
    for (Eigen::Index node = 0; node < weights_.size(); ++node) {
      if (areas_[node] == 0) continue;
      const double distance = std::sqrt(std::norm(smooth_[node] - measured_[node]));
      const double weight = areas_[node] * (distance > threshold_ ? threshold_ / distance : 1);
      greatest_change = std::max(greatest_change, std::abs(weight - weights_[node]) / areas_[node]);
      weights_[node] = weight;
    }
    return greatest_change <= weight_tolerance;
  }

  const Phases& smooth() const { return smooth_; }

 private:
  void set(std::int32_t node, const Phase& z, double area) {
    measured_[node] = z;
    areas_[node] = area;
  }

  /// The Dirichlet energy's matrix, times a factor, cut at barriers.
  void make_matrix(double factor, std::span<const std::int32_t> barriers) {
    std::vector<std::int32_t> triangle_of(connection_.node_count);
    for (std::size_t t = 0; t < connection_.back.size(); ++t) {
      triangle_of[t] = static_cast<std::int32_t>(t);
      if (connection_.back[t] >= 0) triangle_of[connection_.back[t]] = static_cast<std::int32_t>(t);
    }
    std::vector<Eigen::Triplet<Phase>> entries;
    entries.reserve(4 * connection_.edges.size() + connection_.node_count);
    for (std::int32_t node = 0; node < connection_.node_count; ++node) entries.emplace_back(node, node, 0);
    for (const auto& [first, second, transport, weight] : connection_.edges) {
      if (!barriers.empty() && barriers[triangle_of[first]] != barriers[triangle_of[second]]) continue;
      entries.emplace_back(second, first, -factor * weight * transport);
      entries.emplace_back(first, second, -factor * weight * std::conj(transport));
      entries.emplace_back(first, first, factor * weight);
      entries.emplace_back(second, second, factor * weight);
    }
    coupling_.resize(connection_.node_count, connection_.node_count);
    coupling_.setFromTriplets(entries.begin(), entries.end());
    diagonal_.reserve(connection_.node_count);
    for (Eigen::Index node = 0; node < coupling_.cols(); ++node) {
      Eigen::Index place = coupling_.outerIndexPtr()[node];
      while (coupling_.innerIndexPtr()[place] != node) ++place;
      diagonal_.push_back(place);
    }
  }

  detail::Connection connection_;
  double threshold_;          ///< of |z - measured|, beyond which a fibre counts as an outlier
  Phases measured_, smooth_;  ///< per node; 0 where nothing was measured
  Eigen::VectorXd areas_, weights_;
  Matrix coupling_;
  std::vector<Eigen::Index> diagonal_;  ///< where the diagonal entries are among its values
};

double line_angle(const Vec3& a, const Vec3& b) {
  return std::atan2(vector(a).cross(vector(b)).norm(), std::abs(vector(a).dot(vector(b))));
}

}  // namespace

Smoothing smooth(const SurfaceMesh& mesh, const OrientationField& field, const SmoothingOptions& options,
                 std::span<const std::int32_t> barriers) {
  check(mesh, field, options, barriers);
  RobustProblem problem(mesh, field, options, barriers);
  std::int32_t iterations = 0;
  bool converged = false;
  while (!converged && iterations < options.max_iterations) {
    converged = problem.step();
    ++iterations;
  }
  std::vector<Vec3> directions(mesh.triangle_count(), Vec3{0, 0, 0});
  std::vector<double> moved(mesh.triangle_count(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto triangle = static_cast<std::int32_t>(t);
    const Phase z = problem.smooth()[triangle];
    if (z == 0.0 || (!options.fill_missing && !field.has_direction(triangle))) continue;
    directions[t] = detail::vec3(detail::direction_of(z, detail::triangle_frame(mesh, triangle)));
    if (field.has_direction(triangle)) moved[t] = line_angle(directions[t], field.directions()[t]);
  }
  return {detail::field_of_directions(mesh, directions), std::move(moved), iterations, converged};
}

}  // namespace pectinate
