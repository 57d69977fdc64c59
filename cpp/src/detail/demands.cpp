// SPDX-License-Identifier: MIT
#include "detail/demands.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "detail/mesh_geometry.hpp"

namespace pectinate::detail {
namespace {

/// Lines that cancel out each other to this share of their weights have no average.
constexpr double least_resultant = 1e-9;

bool is_hard(const Demand& demand) {
  return demand.weight == hard;
}

double line_angle(const Phase& a, const Phase& b) {
  return std::abs(std::arg(a * std::conj(b))) / 2;
}

bool is_hard_tract(const Demand& demand) {
  return is_hard(demand) && demand.tract >= 0;
}

/// The average of demands that agree; where any is hard, of the hard ones, and of hard tracts without the boundary's.
Demand average(std::span<const Demand> kept) {
  const bool any_hard = std::any_of(kept.begin(), kept.end(), is_hard);
  const bool any_hard_tract = std::any_of(kept.begin(), kept.end(), is_hard_tract);
  Demand result{kept[0].triangle, 0, 0, 0};
  const Demand* first = nullptr;
  double total = 0;
  for (const auto& demand : kept) {
    if (any_hard && !is_hard(demand)) continue;
    if (any_hard_tract && !is_hard_tract(demand)) continue;
    if (!first) first = &demand;
    const double weight = any_hard ? 1 : demand.weight;
    result.phase += weight * demand.phase;
    total += weight;
  }
  const double resultant = std::abs(result.phase);
  result.phase = resultant > least_resultant * total ? result.phase / resultant : first->phase;
  result.weight = any_hard ? hard : std::min(total, greatest_weight);
  result.tract = first->tract;
  return result;
}

/// The stretch of a tract in one triangle between coming in and going out.
struct Passage {
  std::int32_t triangle;
  Vector start, end;
  double length;
  Phase sum;  // of its segments, by length
};

Phase phase_of(const SurfaceMesh& mesh, const Passage& passage) {
  if (std::abs(passage.sum) > least_resultant * passage.length) return passage.sum / std::abs(passage.sum);
  // Its segments cancel out each other, as at a right angle: from where it comes in to where it goes out.
  const Vector through = passage.end - passage.start;
  if (through.norm() > least_resultant * passage.length) {
    return phase_of(through, triangle_frame(mesh, passage.triangle));
  }
  return 1;  // evenly around: no direction is better than another
}

std::vector<Passage> passages(const SurfaceMesh& mesh, const TractCurve& curve) {
  const auto& points = curve.projected.points;
  const auto& triangles = curve.projected.triangles;
  const std::size_t count = triangles.size();
  // A closed tract starts where it comes into a triangle, not within one.
  std::size_t first = 0;
  if (curve.closed) {
    while (first < count && triangles[first] == triangles.back()) ++first;
  }
  std::vector<Passage> found;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t s = (first + i) % count;
    const Vector start = vector(points[s]), end = vector(points[s + 1]);
    if (found.empty() || found.back().triangle != triangles[s]) found.push_back({triangles[s], start, end, 0, 0});
    const double length = (end - start).norm();
    found.back().end = end;
    found.back().length += length;
    found.back().sum += length * phase_of(curve.directions[s], triangle_frame(mesh, triangles[s]));
  }
  return found;
}

}  // namespace

SettledDemands settle(std::vector<Demand> demands, double conflict_angle) {
  std::stable_sort(demands.begin(), demands.end(),
                   [](const Demand& a, const Demand& b) { return a.triangle < b.triangle; });
  SettledDemands settled;
  std::vector<Demand> kept;
  for (std::size_t i = 0; i < demands.size(); ++i) {
    const Demand& demand = demands[i];
    const auto against = std::find_if(kept.begin(), kept.end(), [&](const Demand& other) {
      return line_angle(other.phase, demand.phase) > conflict_angle;
    });
    if (against == kept.end()) {
      kept.push_back(demand);
    } else {
      settled.conflicts.push_back(
          {demand.triangle, against->tract, demand.tract, line_angle(against->phase, demand.phase)});
    }
    if (i + 1 < demands.size() && demands[i + 1].triangle == demand.triangle) continue;
    settled.demands.push_back(average(kept));
    kept.clear();
  }
  return settled;
}

SettledDemands tract_demands(const SurfaceMesh& mesh, const TractCurve& curve, const Tract& tract, std::int32_t index,
                             double conflict_angle) {
  auto all = passages(mesh, curve);
  // Where a tract crosses itself the longest passage prevails, whichever end it was drawn from.
  std::stable_sort(all.begin(), all.end(), [](const Passage& a, const Passage& b) { return a.length > b.length; });
  std::vector<Demand> demands;
  demands.reserve(all.size());
  for (const auto& passage : all) {
    demands.push_back({passage.triangle, phase_of(mesh, passage), passage.length, index});
  }
  auto settled = settle(std::move(demands), conflict_angle);
  for (auto& demand : settled.demands) demand.weight = tract.weight;
  return settled;
}

}  // namespace pectinate::detail
