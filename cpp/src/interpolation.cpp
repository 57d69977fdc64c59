// SPDX-License-Identifier: MIT
#include "pectinate/interpolation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "detail/connection.hpp"
#include "detail/frontal_cholesky.hpp"
#include "detail/number_text.hpp"
#include "detail/phase_system.hpp"
#include "detail/random.hpp"
#include "pectinate/errors.hpp"

namespace pectinate {
namespace {

using detail::Connection;
using detail::Phase;
using detail::PhaseConstraint;
using detail::TriangleFrame;
using detail::vector;

/// Of the mass, added where no constraint holds a component: small against all but the smallest eigenvalue.
constexpr double relative_shift = 1e-8;
constexpr int max_power_iterations = 200;
/// Of the Rayleigh quotient from one iteration to the next.
constexpr double rayleigh_tolerance = 1e-10;

std::vector<TriangleFrame> all_frames(const SurfaceMesh& mesh) {
  std::vector<TriangleFrame> frames;
  frames.reserve(mesh.triangle_count());
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    frames.push_back(detail::triangle_frame(mesh, static_cast<std::int32_t>(t)));
  }
  return frames;
}

/// Where phases count from the reference frame, carrying them over changes nothing.
Connection connection_of(const SurfaceMesh& mesh, const ReferenceFrame& reference,
                         const std::vector<TriangleFrame>& frames) {
  if (reference.longitudinal.size() != mesh.triangle_count()) {
    throw InvalidField("the reference frame has " + std::to_string(reference.longitudinal.size()) +
                       " triangles, but the mesh has " + std::to_string(mesh.triangle_count()) +
                       "; make the frame for this mesh");
  }
  Connection connection = detail::make_connection(mesh);
  for (auto& edge : connection.edges) {
    const auto zero_angle = [&](std::int32_t t) {
      return detail::phase_of(vector(reference.longitudinal[t]), frames[t]);
    };
    edge.transport = zero_angle(edge.second) * std::conj(zero_angle(edge.first));
  }
  return connection;
}

}  // namespace

class FieldInterpolator::State {
 public:
  State(const SurfaceMesh& mesh, std::vector<TriangleFrame> frames, Connection connection)
      : mesh_(mesh),
        frames_(std::move(frames)),
        connection_(std::move(connection)),
        system_(connection_),
        cholesky_(connection_.node_count, system_.edges()),
        triangle_of_(connection_.node_count),
        is_constrained_(mesh.components().size(), false) {
    for (std::int32_t t = 0; t < triangle_count(); ++t) {
      triangle_of_[t] = t;
      if (connection_.back[t] >= 0) triangle_of_[connection_.back[t]] = t;
    }
  }

  Interpolation interpolate(std::span<const TriangleConstraint> constraints) {
    check(constraints);
    const auto changed = constrain(constraints);
    const auto constrained = constrained_components(constraints);
    if (!ready_ || constrained != is_constrained_) {
      is_constrained_ = constrained;
      eliminate_all();
    } else if (!changed.empty()) {
      ready_ = false;  // unless all goes well
      const auto rows = system_.affected(changed);
      system_.update(rows);
      cholesky_.eliminate_again(system_.matrix(), system_.right_hand_side(), rows);
      ready_ = true;
    } else if (solved_) {
      return field_of(constraints);
    }
    solved_ = false;
    const bool any_free = std::ranges::find(is_constrained_, false) != is_constrained_.end();
    phase_ = any_free ? smoothest() : cholesky_.solution();
    solved_ = true;
    return field_of(constraints);
  }

 private:
  std::int32_t triangle_count() const { return static_cast<std::int32_t>(mesh_.triangle_count()); }
  std::int32_t component(std::int32_t node) const { return mesh_.triangle_components()[triangle_of_[node]]; }
  bool is_free(std::int32_t node) const { return !is_constrained_[component(node)]; }
  double mass(std::int32_t node) const {
    return mesh_.triangle_areas()[triangle_of_[node]] * triangle_count() / mesh_.area();
  }

  void check(std::span<const TriangleConstraint> constraints) const {
    std::vector<bool> seen(mesh_.triangle_count(), false);
    for (const auto& [t, direction, weight, tract] : constraints) {
      const std::string which = "the constraint on triangle " + std::to_string(t);
      if (t < 0 || t >= triangle_count()) {
        throw InvalidField(which + " is for a mesh of " + std::to_string(triangle_count()) +
                           " triangles; make constraints for this mesh");
      }
      if (seen[t]) throw InvalidField(which + " is given twice; give one a triangle");
      seen[t] = true;
      if (!(weight >= least_weight && (weight <= greatest_weight || weight == hard))) {
        throw InvalidField(which + " has the weight " + detail::number_text(weight) +
                           ", but weights are from 1e-6 to 1e12, or hard; leave it out or weight it");
      }
      const double height = vector(direction).dot(vector(mesh_.triangle_normals()[t]));
      const double length = vector(direction).norm();
      if (!std::isfinite(length) || !(length - std::abs(height) > 1e-9 * length)) {
        throw InvalidField(which + " has a direction that is zero, not finite or normal to it; give one in its plane");
      }
    }
  }

  PhaseConstraint constraint_of(const TriangleConstraint& given) const {
    return {detail::phase_of(vector(given.direction), frames_[given.triangle]), given.weight};
  }

  /// Sets the constraints of all nodes; the nodes at which they are new.
  std::vector<std::int32_t> constrain(std::span<const TriangleConstraint> constraints) {
    std::vector<bool> stays(mesh_.triangle_count(), false);
    std::vector<std::int32_t> changed;
    const auto set = [&](std::int32_t node, const PhaseConstraint& constraint) {
      if (system_.constraint(node) == constraint) return;
      system_.constrain(node, constraint);
      changed.push_back(node);
    };
    const auto set_triangle = [&](std::int32_t t, const PhaseConstraint& constraint) {
      set(t, constraint);
      if (connection_.back[t] >= 0) set(connection_.back[t], {std::conj(constraint.target), constraint.weight});
    };
    for (const auto& given : constraints) {
      stays[given.triangle] = true;
      set_triangle(given.triangle, constraint_of(given));
    }
    for (const auto t : constrained_) {
      if (!stays[t]) set_triangle(t, {});
    }
    constrained_.clear();
    for (const auto& given : constraints) constrained_.push_back(given.triangle);
    return changed;
  }

  std::vector<bool> constrained_components(std::span<const TriangleConstraint> constraints) const {
    std::vector<bool> constrained(mesh_.components().size(), false);
    for (const auto& given : constraints) constrained[mesh_.triangle_components()[given.triangle]] = true;
    return constrained;
  }

  void eliminate_all() {
    ready_ = false;
    std::vector<std::int32_t> rows(connection_.node_count);
    std::iota(rows.begin(), rows.end(), 0);
    for (const auto node : rows) system_.shift(node, is_free(node) ? relative_shift * mass(node) : 0);
    system_.update(rows);
    cholesky_.eliminate(system_.matrix(), system_.right_hand_side());
    ready_ = true;
  }

  /// The solution, on free components replaced by the phase of least energy for its mean square: by inverse iteration
  /// from noise.
  Eigen::VectorXcd smoothest() {
    Eigen::VectorXcd load = system_.right_hand_side(), phase = load;
    Random random(1);
    for (std::int32_t t = 0; t < triangle_count(); ++t) {
      if (!is_free(t)) continue;
      load[t] = Phase(2 * random.unit() - 1, 2 * random.unit() - 1);
      if (connection_.back[t] >= 0) load[connection_.back[t]] = std::conj(load[t]);
    }
    std::vector<double> quotients(mesh_.components().size(), 0);
    for (int i = 0; i < max_power_iterations; ++i) {
      cholesky_.replace(load);
      phase = cholesky_.solution();
      if (!next_load(phase, load, quotients)) break;
    }
    cholesky_.replace(system_.right_hand_side());
    scale_free(phase);
    return phase;
  }

  /// Makes of a phase the next right hand side: the mass times it, of unit mean square on each free component. False
  /// when no component's Rayleigh quotient changes any more.
  bool next_load(const Eigen::VectorXcd& phase, Eigen::VectorXcd& load, std::vector<double>& quotients) const {
    std::vector<double> squares(quotients.size(), 0), products(quotients.size(), 0);
    for (std::int32_t node = 0; node < connection_.node_count; ++node) {
      squares[component(node)] += mass(node) * std::norm(phase[node]);
      products[component(node)] += (std::conj(phase[node]) * load[node]).real();
    }
    bool moves = false;
    for (std::int32_t node = 0; node < connection_.node_count; ++node) {
      if (is_free(node)) load[node] = mass(node) * phase[node] / std::sqrt(squares[component(node)]);
    }
    for (std::size_t c = 0; c < quotients.size(); ++c) {
      if (is_constrained_[c]) continue;
      const double quotient = products[c] / squares[c];
      moves = moves || !(std::abs(quotient - quotients[c]) <= rayleigh_tolerance * std::abs(quotient));
      quotients[c] = quotient;
    }
    return moves;
  }

  void scale_free(Eigen::VectorXcd& phase) const {
    std::vector<double> greatest(mesh_.components().size(), 0);
    for (std::int32_t node = 0; node < connection_.node_count; ++node) {
      greatest[component(node)] = std::max(greatest[component(node)], std::abs(phase[node]));
    }
    for (std::int32_t node = 0; node < connection_.node_count; ++node) {
      if (is_free(node)) phase[node] /= greatest[component(node)];
    }
  }

  Interpolation field_of(std::span<const TriangleConstraint> constraints) const {
    std::vector<Vec3> directions(mesh_.triangle_count(), Vec3{0, 0, 0});
    std::vector<double> confidence(mesh_.triangle_count());
    for (std::int32_t t = 0; t < triangle_count(); ++t) {
      confidence[t] = std::min(std::sqrt(std::norm(phase_[t])), 1.0);
      if (confidence[t] > 0) directions[t] = detail::vec3(detail::direction_of(phase_[t], frames_[t]));
    }
    for (const auto& [t, direction, weight, tract] : constraints) {
      if (!std::isinf(weight)) continue;
      const detail::Vector normal = vector(mesh_.triangle_normals()[t]), unit = vector(direction).normalized();
      directions[t] = detail::vec3((unit - unit.dot(normal) * normal).normalized());
      confidence[t] = 1;
    }
    return {OrientationField::from_planar_units(mesh_, std::move(directions)), std::move(confidence)};
  }

  const SurfaceMesh& mesh_;
  std::vector<TriangleFrame> frames_;
  Connection connection_;
  detail::PhaseSystem system_;
  detail::FrontalCholesky cholesky_;
  std::vector<std::int32_t> triangle_of_;  ///< per node
  std::vector<bool> is_constrained_;       ///< per component
  std::vector<std::int32_t> constrained_;  ///< triangles
  Eigen::VectorXcd phase_;                 ///< the solution, per node
  bool ready_ = false;                     ///< the factorization is that of the system
  bool solved_ = false;                    ///< and so is the phase
};

FieldInterpolator::FieldInterpolator(const SurfaceMesh& mesh)
    : state_(std::make_unique<State>(mesh, all_frames(mesh), detail::make_connection(mesh))) {}

FieldInterpolator::FieldInterpolator(const SurfaceMesh& mesh, const ReferenceFrame& frame) {
  auto frames = all_frames(mesh);
  auto connection = connection_of(mesh, frame, frames);
  state_ = std::make_unique<State>(mesh, std::move(frames), std::move(connection));
}

FieldInterpolator::FieldInterpolator(FieldInterpolator&&) noexcept = default;
FieldInterpolator& FieldInterpolator::operator=(FieldInterpolator&&) noexcept = default;
FieldInterpolator::~FieldInterpolator() = default;

Interpolation FieldInterpolator::interpolate(std::span<const TriangleConstraint> constraints) {
  return state_->interpolate(constraints);
}

Interpolation interpolate(const SurfaceMesh& mesh, std::span<const TriangleConstraint> constraints) {
  return FieldInterpolator(mesh).interpolate(constraints);
}

Interpolation interpolate(const SurfaceMesh& mesh, const ReferenceFrame& frame,
                          std::span<const TriangleConstraint> constraints) {
  return FieldInterpolator(mesh, frame).interpolate(constraints);
}

}  // namespace pectinate
