// SPDX-License-Identifier: MIT
#include "pectinate/smoothing.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "detail/connection.hpp"
#include "detail/field_of_directions.hpp"
#include "detail/fit_checks.hpp"
#include "detail/frontal_cholesky.hpp"
#include "detail/number_text.hpp"
#include "pectinate/comparison.hpp"
#include "pectinate/errors.hpp"

namespace pectinate {
namespace {

using detail::Phase;
using detail::vector;
using Phases = Eigen::VectorXcd;

/// Where Geman and McClure's loss bends over: 20 degrees, as |exp(2 i a) - 1|.
const double consensus_scale = 2 * std::sin(20 * std::numbers::pi / 180);
/// Reweighted solves. The loss is not convex: from the mean of all fibres the consensus settles in this many.
constexpr int consensus_steps = 10;
/// Of the length: over which the fibres that are kept are smoothed.
constexpr double final_share = 0.18;
/// Of the area, as the weight of a dropped fibre: it counts only where nothing else does.
constexpr double dropped_weight = 1e-6;
/// Of the coupling to the neighbours, as the weight of a triangle without a fibre: alone these would be singular.
constexpr double unmeasured_hold = 1e-10;
/// Lengths in diagonals of the bounding box: below, nothing is smoothed; far above, all fibres of a component are one
/// already, and rounding takes over in the end.
constexpr double least_length = 1e-6, greatest_length = 10;

void check(const SurfaceMesh& mesh, const OrientationField& field, const SmoothingOptions& options,
           std::span<const std::int32_t> barriers) {
  const double diagonal = mesh.bounding_box_diagonal();
  if (!(options.length >= least_length * diagonal && options.length <= greatest_length * diagonal)) {
    throw InvalidOption("length is " + detail::number_text(options.length) +
                        ", but must be from a millionth of the diagonal of the mesh's bounding box to ten of them, " +
                        detail::number_text(least_length * diagonal) + " to " +
                        detail::number_text(greatest_length * diagonal) + "; give the size of what to smooth away");
  }
  if (!(options.outlier_angle > 0 && options.outlier_angle <= std::numbers::pi / 2)) {
    throw InvalidOption("outlier_angle is " + detail::number_text(options.outlier_angle) +
                        ", but must be in (0, pi/2] radians");
  }
  if (!barriers.empty() && barriers.size() != mesh.triangle_count()) {
    throw InvalidOption("there are " + std::to_string(barriers.size()) + " barrier labels, but the mesh has " +
                        std::to_string(mesh.triangle_count()) + " triangles; give one for each");
  }
  detail::check_is_on(mesh, field);
}

/// The mesh's connection without the edges between triangles of different label.
detail::Connection connection_within(const SurfaceMesh& mesh, std::span<const std::int32_t> barriers) {
  detail::Connection connection = detail::make_connection(mesh);
  if (barriers.empty()) return connection;
  std::vector<std::int32_t> label(connection.node_count);
  for (std::size_t t = 0; t < barriers.size(); ++t) {
    label[t] = barriers[t];
    if (connection.back[t] >= 0) label[connection.back[t]] = barriers[t];
  }
  std::erase_if(connection.edges, [&](const auto& edge) { return label[edge.first] != label[edge.second]; });
  return connection;
}

std::vector<detail::FrontalCholesky::Edge> ends(const std::vector<detail::ConnectionEdge>& edges) {
  std::vector<detail::FrontalCholesky::Edge> all;
  all.reserve(edges.size());
  for (const auto& edge : edges) all.push_back({edge.first, edge.second});
  return all;
}

/// Weighted least squares on phases: the sum of weight |z - measured|^2, plus a factor times the Dirichlet energy.
class PhaseFit {
 public:
  PhaseFit(const SurfaceMesh& mesh, const OrientationField& field, std::span<const std::int32_t> barriers)
      : mesh_(mesh),
        connection_(connection_within(mesh, barriers)),
        measured_(Phases::Zero(connection_.node_count)),
        matrix_{{}, std::vector<Phase>(connection_.edges.size())},
        cholesky_(connection_.node_count, ends(connection_.edges)) {
    for (std::int32_t t = 0; t < triangle_count(); ++t) {
      if (!field.has_direction(t)) continue;
      measured_[t] = detail::phase_of(vector(field.directions()[t]), detail::triangle_frame(mesh, t));
      if (connection_.back[t] >= 0) measured_[connection_.back[t]] = std::conj(measured_[t]);
    }
  }

  std::int32_t triangle_count() const { return static_cast<std::int32_t>(mesh_.triangle_count()); }
  const Phase& measured(std::int32_t triangle) const { return measured_[triangle]; }

  /// `trust(triangle)` is the weight of a measured fibre, as a share of its area; positive.
  template <class Trust>
  Phases solve(double factor, const Trust& trust) {
    matrix_.diagonal.assign(connection_.node_count, 0);
    Phases pull = Phases::Zero(connection_.node_count);
    for (std::int32_t t = 0; t < triangle_count(); ++t) {
      const double area = mesh_.triangle_areas()[t];
      const double weight = measured_[t] == 0.0 ? unmeasured_hold * factor : area * trust(t);
      for (const auto node : {t, connection_.back[t]}) {
        if (node < 0) continue;
        matrix_.diagonal[node] = weight;
        pull[node] = weight * measured_[node];
      }
    }
    for (std::size_t e = 0; e < connection_.edges.size(); ++e) {
      const auto& [first, second, transport, weight] = connection_.edges[e];
      matrix_.edges[e] = -factor * weight * transport;
      matrix_.diagonal[first] += factor * weight;
      matrix_.diagonal[second] += factor * weight;
    }
    cholesky_.eliminate(matrix_, pull);
    return cholesky_.solution();
  }

 private:
  const SurfaceMesh& mesh_;
  detail::Connection connection_;
  Phases measured_;  ///< per node; 0 where nothing was measured
  detail::HermitianMatrix matrix_;
  detail::FrontalCholesky cholesky_;
};

/// What most fibres around each triangle say.
Phases find_consensus(PhaseFit& fit, double factor) {
  Phases consensus = fit.solve(factor, [](std::int32_t) { return 1.0; });
  for (int step = 1; step < consensus_steps; ++step) {
    const Phases last = std::move(consensus);
    consensus = fit.solve(factor, [&](std::int32_t t) {
      const double excess = std::norm(last[t] - fit.measured(t)) / (consensus_scale * consensus_scale);
      return std::max(1 / ((1 + excess) * (1 + excess)), 1e-4);
    });
  }
  return consensus;
}

/// As the angle between the lines; of a phase of 0, any.
std::vector<std::uint8_t> find_outliers(const PhaseFit& fit, const Phases& consensus, double outlier_angle) {
  std::vector<std::uint8_t> outliers(fit.triangle_count(), 0);
  for (std::int32_t t = 0; t < fit.triangle_count(); ++t) {
    outliers[t] = std::abs(std::arg(consensus[t] * std::conj(fit.measured(t)))) / 2 > outlier_angle;
  }
  return outliers;
}

}  // namespace

Smoothing smooth(const SurfaceMesh& mesh, const OrientationField& field, const SmoothingOptions& options,
                 std::span<const std::int32_t> barriers) {
  check(mesh, field, options, barriers);
  PhaseFit fit(mesh, field, barriers);
  const double factor = options.length * options.length / 2;
  auto outliers = find_outliers(fit, find_consensus(fit, factor), options.outlier_angle);
  const Phases smooth = fit.solve(final_share * final_share * factor,
                                  [&](std::int32_t t) { return outliers[t] != 0 ? dropped_weight : 1.0; });
  std::vector<Vec3> directions(mesh.triangle_count(), Vec3{0, 0, 0});
  for (std::int32_t t = 0; t < fit.triangle_count(); ++t) {
    if (smooth[t] == 0.0 || (!options.fill_missing && !field.has_direction(t))) continue;
    directions[t] = detail::vec3(detail::direction_of(smooth[t], detail::triangle_frame(mesh, t)));
  }
  auto smoothed = detail::field_of_directions(mesh, directions);
  auto moved_angles = angles_between(smoothed, field);
  return {std::move(smoothed), std::move(moved_angles), std::move(outliers)};
}

}  // namespace pectinate
