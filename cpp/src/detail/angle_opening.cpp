// SPDX-License-Identifier: MIT
#include "detail/angle_opening.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace pectinate::detail {

namespace {

constexpr int sweeps = 40;
constexpr int directions = 8;
constexpr double wide_enough = 42 * std::numbers::pi / 180;
constexpr double first_step = 0.15, last_step = 0.003;  // of the edge length

class AngleOpener {
 public:
  AngleOpener(CutTriangles& mesh, const ImplicitSurface& surface, double edge_length)
      : vertices_(mesh.surface.vertices),
        triangles_(mesh.surface.triangles),
        surface_(surface),
        edge_length_(edge_length),
        stars_(vertices_.size()),
        borders_(vertices_.size(), nullptr),
        steps_(vertices_.size(), first_step * edge_length) {
    for (const Triangle& triangle : triangles_)
      for (const std::int32_t v : triangle) stars_[v].push_back(triangle);
    for (std::size_t i = 0; i < mesh.loops.size(); ++i)
      for (const std::int32_t v : mesh.loops[i]) borders_[v] = &surface.cuts[i];
  }

  void sweep() {
    for (std::int32_t v = 0; v < static_cast<std::int32_t>(vertices_.size()); ++v) {
      if (steps_[v] < last_step * edge_length_) continue;
      const double angle = smallest_angle(v, vertices_[v]);
      if (angle < wide_enough) widen(v, angle);
    }
  }

 private:
  /// Of the triangles about a vertex, were it elsewhere; negative where one of them would face inwards.
  double smallest_angle(std::int32_t vertex, const Vector& position) const {
    const Vector outwards = surface_.function(position).gradient;
    double largest_cosine = -1;
    for (const Triangle& triangle : stars_[vertex]) {
      std::array<Vector, 3> corners;
      for (int k = 0; k < 3; ++k) corners[k] = triangle[k] == vertex ? position : vertices_[triangle[k]];
      for (int k = 0; k < 3; ++k) {
        const Vector a = corners[(k + 1) % 3] - corners[k], b = corners[(k + 2) % 3] - corners[k];
        if (a.cross(b).dot(outwards) <= 0) return -1;
        largest_cosine = std::max(largest_cosine, a.dot(b) / std::sqrt(a.squaredNorm() * b.squaredNorm()));
      }
    }
    return std::acos(std::min(largest_cosine, 1.0));
  }

  void widen(std::int32_t vertex, double angle) {
    const Vector normal = surface_.function(vertices_[vertex]).gradient.normalized();
    const Vector u = normal.unitOrthogonal(), v = normal.cross(u);
    Vector best = vertices_[vertex];
    for (int i = 0; i < directions; ++i) {
      const double turn = 2 * std::numbers::pi * i / directions;
      const Vector moved = vertices_[vertex] + steps_[vertex] * (std::cos(turn) * u + std::sin(turn) * v);
      const Cut* const border = borders_[vertex];
      const Vector drawn = border ? project_to_border(surface_, *border, moved) : project(surface_, moved);
      const double opened = smallest_angle(vertex, drawn);
      if (opened <= angle) continue;
      angle = opened;
      best = drawn;
    }
    if (best == vertices_[vertex]) steps_[vertex] /= 2;
    vertices_[vertex] = best;
  }

  std::vector<Vector>& vertices_;
  const std::vector<Triangle>& triangles_;
  const ImplicitSurface& surface_;
  double edge_length_;
  std::vector<std::vector<Triangle>> stars_;
  std::vector<const Cut*> borders_;  ///< none in the interior
  std::vector<double> steps_;
};

}  // namespace

void open_angles(CutTriangles& mesh, const ImplicitSurface& surface, double edge_length) {
  AngleOpener opener(mesh, surface, edge_length);
  for (int i = 0; i < sweeps; ++i) opener.sweep();
}

}  // namespace pectinate::detail
