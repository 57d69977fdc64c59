// SPDX-License-Identifier: MIT
// Triangles side by side, for files that are compiled once for each kind of processor (kernel_variants.inl).

#include "detail/lane_vectors.inl"

/// Of what is given for each lane.
template <class VectorOf>
inline LaneVector gather(const VectorOf& vector_of) {
  const auto coordinate = [&](int k) { return lanes([&](int lane) { return vector_of(lane)[k]; }); };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

struct LaneTriangles {
  LaneVector a, b, c;  // corners
};

/// As many triangles as there are lanes, from one on; the last one once more where there are fewer.
inline LaneTriangles gather_triangles(const Vec3* vertices, std::span<const Triangle> triangles, std::size_t first) {
  const auto corners = [&](int k) {
    return gather(
        [&](int lane) -> const Vec3& { return vertices[triangles[std::min(first + lane, triangles.size() - 1)][k]]; });
  };
  return {corners(0), corners(1), corners(2)};
}
