// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "detail/scratch.hpp"
#include "pectinate/surface_mesh.hpp"

namespace pectinate::detail {

/// What is valid in a triangle soup, compact, in input order, with the maps back.
struct TriangleSoup {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<double> areas;
  std::vector<std::int32_t> input_vertex, input_triangle;  ///< empty where they count up
  MeshRepairs repairs;                                     ///< what was dropped
};

inline std::int32_t input_index(const std::vector<std::int32_t>& input, std::int32_t i) {
  return input.empty() ? i : input[i];
}

/// With numbers where it was empty.
std::vector<std::int32_t> written_out(std::vector<std::int32_t> input, std::size_t count);

/// Throws InvalidMesh for more than can be numbered.
void check_sizes(std::size_t vertex_count, std::size_t triangle_count);

/// Drops triangles with non-finite corners and degenerate ones, then vertices that nothing uses. Uses an empty soup's
/// room. Throws InvalidMesh for an index out of range or when nothing is left.
TriangleSoup clean_triangle_soup(std::span<const Vec3> vertices, std::span<const Triangle> triangles, TriangleSoup room,
                                 Scratch& scratch);

/// Among some triangles of a soup, in ascending order, all but the first of those with the same three corners.
std::vector<std::int32_t> find_repetitions(const TriangleSoup& soup, const std::vector<std::int32_t>& candidates);

/// Without triangles that are exact repetitions of others that stay.
TriangleSoup drop_repetitions(TriangleSoup soup, const std::vector<std::int32_t>& repetitions);

}  // namespace pectinate::detail
