// SPDX-License-Identifier: MIT
#include "detail/orient.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <span>

#include "detail/triangle_measures.hpp"
#include "detail/vec.hpp"

namespace pectinate::detail {
namespace {

/// Below this volume over area^1.5 (a sphere has 0.094) inside and outside are no matter of the surface's shape.
constexpr double least_relative_volume = 1e-3;

/// Components as they are found. A triangle's state is twice its component, and one more where it is to be reversed.
class Flood {
 public:
  Flood(const Neighbours& neighbours, std::vector<std::int32_t> room, Scratch& scratch)
      : neighbours_(neighbours),
        states_(std::move(room)),
        reached_(scratch.array<std::int32_t>(neighbours.size() + 1)) {
    states_.assign(neighbours.size(), -1);
  }

  bool has_reached(std::int32_t t) const { return states_[t] >= 0; }

  /// Numbers the component of a triangle; tells whether it is orientable.
  bool fill(std::int32_t start, std::int32_t component) {
    const auto first = end_;
    states_[start] = 2 * component;
    reached_[end_++] = start;
    std::int32_t is_twisted = 0;
    std::size_t reversed = 0;
    for (auto i = first; i < end_; ++i) {
      const auto state = states_[reached_[i]];
      reversed += state & 1;
      for (const auto across : neighbours_[reached_[i]]) {
        if (!across.exists()) continue;
        const auto other = across.triangle(), before = states_[other];
        const auto expected = state ^ static_cast<std::int32_t>(across.runs_alike());
        // Whether it is new is anyone's guess, so there is no branch: it is noted anyhow.
        const bool is_new = before < 0;
        states_[other] = is_new ? expected : before;
        is_twisted |= is_new ? 0 : before ^ expected;
        reached_[end_] = other;
        end_ += is_new;
        __builtin_prefetch(&neighbours_[other]);  // by the time its turn comes it will be at hand
      }
    }
    if (2 * reversed > end_ - first) {
      for (auto i = first; i < end_; ++i) states_[reached_[i]] ^= 1;
    }
    return is_twisted == 0;
  }

  std::vector<std::int32_t> take_states() && { return std::move(states_); }

 private:
  const Neighbours& neighbours_;
  std::vector<std::int32_t> states_;
  std::span<std::int32_t> reached_;
  std::size_t end_ = 0;  // of what was reached
};

}  // namespace

Orientation find_orientation(const Neighbours& neighbours, std::vector<std::int32_t> room, Scratch& scratch) {
  scratch.next_step();
  const auto count = static_cast<std::int32_t>(neighbours.size());
  Orientation result;
  Flood flood(neighbours, std::move(room), scratch);
  for (std::int32_t start = 0; start < count; ++start) {
    if (flood.has_reached(start)) continue;
    const auto component = static_cast<std::int32_t>(result.orientable.size());
    result.orientable.push_back(flood.fill(start, component));
  }
  result.triangle_components = std::move(flood).take_states();
  for (std::int32_t t = 0; t < count; ++t) {
    auto& state = result.triangle_components[t];
    if (state & 1) result.to_reverse.push_back(t);
    state >>= 1;
  }
  return result;
}

std::vector<bool> points_inwards(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                                 const std::vector<std::int32_t>& triangle_components,
                                 const std::vector<SurfaceComponent>& components,
                                 const std::vector<BoundaryLoop>& loops) {
  std::vector<double> volume(components.size(), 0);  // six times
  std::vector<Vector> origin;                        // a vertex of each; they are numbered as they begin
  for (std::size_t t = 0; origin.size() < components.size(); ++t) {
    if (triangle_components[t] == std::ssize(origin)) origin.push_back(vector(vertices[triangles[t][0]]));
  }
  for (std::size_t first = 0, last = 0; first < triangles.size(); first = last) {
    const auto component = triangle_components[first];
    while (last < triangles.size() && triangle_components[last] == component) ++last;
    volume[component] += measure_volume(vertices, {&triangles[first], last - first}, vec3(origin[component]));
  }
  for (const auto& loop : loops) {
    const Vector& from = origin[loop.component];
    const Vector apex = vector(loop.centroid) - from;
    for (std::size_t i = 0; i < loop.vertices.size(); ++i) {
      const Vector a = vector(vertices[loop.vertices[i]]) - from;
      const Vector b = vector(vertices[loop.vertices[(i + 1) % loop.vertices.size()]]) - from;
      volume[loop.component] += apex.dot(b.cross(a));
    }
  }
  std::vector<bool> inwards(components.size());
  for (std::size_t c = 0; c < components.size(); ++c) {
    inwards[c] = components[c].orientable && volume[c] / 6 < -least_relative_volume * std::pow(components[c].area, 1.5);
  }
  return inwards;
}

}  // namespace pectinate::detail
