// SPDX-License-Identifier: MIT
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <utility>
#include <vector>

#include "detail/capsule.hpp"
#include "detail/edge_point.hpp"
#include "fields.hpp"
#include "pectinate/occupancy.hpp"
#include "pectinate/tracing.hpp"

/// What is true of every streamline.
namespace pectinate::test {

inline std::vector<detail::Vector> places(const SurfaceMesh& mesh, const Streamline& line) {
  std::vector<detail::Vector> result;
  for (const auto& point : line.points) result.push_back(detail::position(mesh, point));
  return result;
}

inline double distance_to_polyline(const detail::Vector& point, const std::vector<detail::Vector>& line) {
  double least = (point - line[0]).norm();
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    least = std::min(least, detail::distance_to_segment(point, line[i], line[i + 1]));
  }
  return least;
}

inline bool has_edge(const SurfaceMesh& mesh, std::int32_t t, std::int32_t edge) {
  const auto& edges = mesh.triangle_edges()[t];
  return std::find(edges.begin(), edges.end(), edge) != edges.end();
}

/// Points lie inside edges; each segment joins two sides of its triangle along its direction, as far as points that
/// were moved away from vertices allow; consecutive triangles are joined.
inline void check_streamline(const SurfaceMesh& mesh, const OrientationField& field, const Streamline& line) {
  REQUIRE(line.points.size() == line.triangles.size() + 1);
  CHECK(line.seed_index >= 0);
  CHECK(line.seed_index <= static_cast<std::int64_t>(line.triangles.size()));
  const auto at = places(mesh, line);
  double length = 0;
  for (std::size_t i = 0; i < line.triangles.size(); ++i) {
    const auto t = line.triangles[i];
    const auto &from = line.points[i], &to = line.points[i + 1];
    CHECK((from.position > 0 && from.position < 1));
    CHECK((to.position > 0 && to.position < 1));
    CHECK(from.edge != to.edge);
    CHECK(has_edge(mesh, t, from.edge));
    CHECK(has_edge(mesh, t, to.edge));
    const detail::Vector step = at[i + 1] - at[i], direction = detail::vector(field.directions()[t]);
    const double size = *std::max_element(mesh.edge_lengths().begin(), mesh.edge_lengths().end());
    CHECK(step.cross(direction).norm() <= 2e-7 * step.norm() + 1e-8 * size);
    length += step.norm();
    bool joined = i == 0;
    for (int k = 0; k < 3 && i > 0; ++k) {
      joined |= mesh.triangle_edges()[t][k] == from.edge && mesh.neighbour(t, k).triangle == line.triangles[i - 1];
    }
    CHECK(joined);
  }
  CHECK(line.length == doctest::Approx(length).epsilon(1e-6));
}

/// Admits what a function of the exit point, or of the seed, admits.
class RuledOccupancy final : public Occupancy {
 public:
  explicit RuledOccupancy(std::function<bool(const EdgePoint&)> rule) : rule_(std::move(rule)) {}
  bool admits(std::int32_t, double, const EdgePoint& exit) const override { return rule_(exit); }
  void add(const Streamline&) override {}
  void retire_seed(const Seed&) override {}
  bool admits_seed(const Seed& seed) const override { return rule_(seed.point); }
  std::optional<Seed> draw_seed(SeedRegion, Random&) const override { return std::nullopt; }
  double coverage() const override { return 0; }

 private:
  std::function<bool(const EdgePoint&)> rule_;
};

}  // namespace pectinate::test
