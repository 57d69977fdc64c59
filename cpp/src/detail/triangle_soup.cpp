// SPDX-License-Identifier: MIT
#include "detail/triangle_soup.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "detail/buckets.hpp"
#include "detail/vec.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::detail {
namespace {

/// Below this height over the longest side a triangle has no usable plane in double precision.
constexpr double least_relative_height = 1e-8;

bool is_finite(const Vec3& v) {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

void check_sizes(std::size_t vertex_count, std::size_t triangle_count) {
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()) / 4;
  if (vertex_count > most || triangle_count > most) {
    throw InvalidMesh("the mesh has more than " + std::to_string(most) + " vertices or triangles; split it");
  }
}

void check_indices(std::span<const Triangle> triangles, std::size_t vertex_count) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const auto v : triangles[t]) {
      if (v < 0 || static_cast<std::size_t>(v) >= vertex_count) {
        throw InvalidMesh("triangle " + std::to_string(t) + " refers to vertex " + std::to_string(v) +
                          ", but vertices are numbered from 0 to " + std::to_string(vertex_count) +
                          " - 1; correct the index or shift it to start at 0");
      }
    }
  }
}

bool is_degenerate(const Triangle& t, std::span<const Vec3> vertices) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
  const Vector a = vector(vertices[t[1]]) - vector(vertices[t[0]]);
  const Vector b = vector(vertices[t[2]]) - vector(vertices[t[0]]);
  const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
  const double twice_area = a.cross(b).norm();
  return !(twice_area > least_relative_height * longest && std::isfinite(twice_area));
}

/// Of triangles with the same three corners, all but the first.
std::vector<std::int32_t> find_repetitions(std::span<const Triangle> triangles, std::size_t vertex_count,
                                           const std::vector<std::int32_t>& candidates) {
  struct Corners {
    std::uint64_t others;  // the two greater ones
    std::int32_t least, triangle;
  };
  std::vector<Corners> all;
  all.reserve(candidates.size());
  for (const auto t : candidates) {
    auto sorted = triangles[t];
    std::sort(sorted.begin(), sorted.end());
    const auto others = static_cast<std::uint64_t>(sorted[1]) << 32 | static_cast<std::uint64_t>(sorted[2]);
    all.push_back({others, sorted[0], t});
  }
  std::vector<std::int32_t> repeated;
  Buckets<Corners> by_least(all, vertex_count, [](const Corners& corners) { return corners.least; });
  for (std::size_t v = 0; v < by_least.count(); ++v) {
    const auto bucket = by_least.bucket(v);
    std::sort(bucket.begin(), bucket.end(), [](const Corners& a, const Corners& b) {
      return a.others != b.others ? a.others < b.others : a.triangle < b.triangle;
    });
    for (std::size_t i = 1; i < bucket.size(); ++i) {
      if (bucket[i].others == bucket[i - 1].others) repeated.push_back(bucket[i].triangle);
    }
  }
  std::sort(repeated.begin(), repeated.end());
  return repeated;
}

/// Sorts the triangles into kept and dropped; returns the kept ones.
std::vector<std::int32_t> select_triangles(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                           MeshRepairs& repairs) {
  std::vector<std::int32_t> valid;
  valid.reserve(triangles.size());
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(triangles.size()); ++t) {
    const auto& corners = triangles[t];
    if (!std::all_of(corners.begin(), corners.end(), [&](auto v) { return is_finite(vertices[v]); })) {
      repairs.non_finite_triangles.push_back(t);
    } else if (is_degenerate(corners, vertices)) {
      repairs.degenerate_triangles.push_back(t);
    } else {
      valid.push_back(t);
    }
  }
  repairs.duplicate_triangles = find_repetitions(triangles, vertices.size(), valid);
  std::vector<std::int32_t> kept;
  kept.reserve(valid.size());
  std::set_difference(valid.begin(), valid.end(), repairs.duplicate_triangles.begin(),
                      repairs.duplicate_triangles.end(), std::back_inserter(kept));
  return kept;
}

}  // namespace

TriangleSoup clean_triangle_soup(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
  check_sizes(vertices.size(), triangles.size());
  check_indices(triangles, vertices.size());
  TriangleSoup soup;
  soup.input_triangle = select_triangles(vertices, triangles, soup.repairs);
  if (soup.input_triangle.empty()) {
    throw InvalidMesh("none of the " + std::to_string(triangles.size()) +
                      " triangles is valid (finite, with an area); check the coordinates and the indices");
  }

  soup.vertices.reserve(vertices.size());
  soup.input_vertex.reserve(vertices.size());
  constexpr std::int32_t unused = -1;
  std::vector<std::int32_t> compact(vertices.size(), unused);
  for (const auto t : soup.input_triangle) {
    for (const auto v : triangles[t]) compact[v] = 0;
  }
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(vertices.size()); ++v) {
    if (compact[v] != unused) {
      compact[v] = static_cast<std::int32_t>(soup.vertices.size());
      soup.vertices.push_back(vertices[v]);
      soup.input_vertex.push_back(v);
    } else {
      (is_finite(vertices[v]) ? soup.repairs.unreferenced_vertices : soup.repairs.non_finite_vertices).push_back(v);
    }
  }
  soup.triangles.reserve(soup.input_triangle.size());
  for (const auto t : soup.input_triangle) {
    const auto& corners = triangles[t];
    soup.triangles.push_back({compact[corners[0]], compact[corners[1]], compact[corners[2]]});
  }
  return soup;
}

}  // namespace pectinate::detail
