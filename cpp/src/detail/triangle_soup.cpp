// SPDX-License-Identifier: MIT
#include "detail/triangle_soup.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "detail/buckets.hpp"
#include "detail/triangle_measures.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::detail {
namespace {

bool is_finite(const Vec3& v) {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

void check_indices(std::span<const Triangle> triangles, std::size_t vertex_count) {
  const auto is_wrong = [&](std::int32_t v) { return static_cast<std::uint32_t>(v) >= vertex_count; };
  bool are_wrong = false;  // told without a branch for each, so that many are looked at together
  for (const auto& [a, b, c] : triangles) are_wrong |= is_wrong(a) | is_wrong(b) | is_wrong(c);
  if (!are_wrong) return;
  const auto wrong = std::ranges::find_if(triangles, [&](const auto& t) { return std::ranges::any_of(t, is_wrong); });
  throw InvalidMesh("triangle " + std::to_string(wrong - triangles.begin()) + " refers to vertex " +
                    std::to_string(*std::ranges::find_if(*wrong, is_wrong)) + ", but vertices are numbered from 0 to " +
                    std::to_string(vertex_count) + " - 1; correct the index or shift it to start at 0");
}

/// Rows without some of them, which are given in ascending order.
template <class Row>
std::vector<Row> without(std::vector<Row> rows, const std::vector<std::int32_t>& dropped) {
  auto next = dropped.begin();
  std::size_t kept = dropped[0];
  for (auto i = kept; i < rows.size(); ++i) {
    if (next != dropped.end() && static_cast<std::size_t>(*next) == i) {
      ++next;
    } else {
      rows[kept++] = rows[i];
    }
  }
  rows.resize(kept);
  return rows;
}

TriangleSoup without_triangles(TriangleSoup soup, const std::vector<std::int32_t>& dropped) {
  if (dropped.empty()) return soup;
  soup.input_triangle = without(written_out(std::move(soup.input_triangle), soup.triangles.size()), dropped);
  soup.triangles = without(std::move(soup.triangles), dropped);
  soup.areas = without(std::move(soup.areas), dropped);
  return soup;
}

/// The valid triangles, of the input's vertices.
TriangleSoup select_triangles(std::span<const Vec3> vertices, std::span<const Triangle> triangles, TriangleSoup soup) {
  check_indices(triangles, vertices.size());
  soup.triangles.assign(triangles.begin(), triangles.end());
  measure_areas(vertices, triangles, soup.areas);
  std::vector<std::int32_t> dropped;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (std::isnan(soup.areas[t])) dropped.push_back(static_cast<std::int32_t>(t));
  }
  for (const auto t : dropped) {
    const auto& corners = triangles[t];
    const bool are_finite = std::all_of(corners.begin(), corners.end(), [&](auto v) { return is_finite(vertices[v]); });
    (are_finite ? soup.repairs.degenerate_triangles : soup.repairs.non_finite_triangles).push_back(t);
  }
  return without_triangles(std::move(soup), dropped);
}

/// The vertices that triangles use, and the triangles with their new numbers.
TriangleSoup with_used_vertices(TriangleSoup soup, std::span<const Vec3> vertices, Scratch& scratch) {
  scratch.next_step();
  const auto is_used = scratch.array<std::uint8_t>(vertices.size(), 0);
  for (const auto& [a, b, c] : soup.triangles) is_used[a] = is_used[b] = is_used[c] = 1;
  if (std::ranges::find(is_used, 0) == is_used.end()) {
    soup.vertices.assign(vertices.begin(), vertices.end());
    return soup;
  }
  std::vector<std::int32_t> compact(vertices.size());
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(vertices.size()); ++v) {
    if (is_used[v]) {
      compact[v] = static_cast<std::int32_t>(soup.vertices.size());
      soup.vertices.push_back(vertices[v]);
      soup.input_vertex.push_back(v);
    } else {
      (is_finite(vertices[v]) ? soup.repairs.unreferenced_vertices : soup.repairs.non_finite_vertices).push_back(v);
    }
  }
  for (auto& triangle : soup.triangles) {
    for (auto& corner : triangle) corner = compact[corner];
  }
  return soup;
}

}  // namespace

void check_sizes(std::size_t vertex_count, std::size_t triangle_count) {
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()) / 4;
  if (vertex_count > most || triangle_count > most) {
    throw InvalidMesh("the mesh has more than " + std::to_string(most) + " vertices or triangles; split it");
  }
}

std::vector<std::int32_t> written_out(std::vector<std::int32_t> input, std::size_t count) {
  if (!input.empty()) return input;
  input.resize(count);
  std::iota(input.begin(), input.end(), 0);
  return input;
}

std::vector<std::int32_t> find_repetitions(const TriangleSoup& soup, const std::vector<std::int32_t>& candidates) {
  if (candidates.empty()) return {};
  struct Corners {
    std::uint64_t others;  // the two greater ones
    std::int32_t least, triangle;
  };
  std::vector<Corners> all;
  all.reserve(candidates.size());
  for (const auto t : candidates) {
    auto sorted = soup.triangles[t];
    std::sort(sorted.begin(), sorted.end());
    const auto others = static_cast<std::uint64_t>(sorted[1]) << 32 | static_cast<std::uint64_t>(sorted[2]);
    all.push_back({others, sorted[0], t});
  }
  std::vector<std::int32_t> repeated;
  Buckets<Corners> by_least(all, soup.vertices.size(), [](const Corners& corners) { return corners.least; });
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

TriangleSoup clean_triangle_soup(std::span<const Vec3> vertices, std::span<const Triangle> triangles, TriangleSoup room,
                                 Scratch& scratch) {
  auto soup = select_triangles(vertices, triangles, std::move(room));
  if (soup.triangles.empty()) {
    throw InvalidMesh("none of the " + std::to_string(triangles.size()) +
                      " triangles is valid (finite, with an area); check the coordinates and the indices");
  }
  return with_used_vertices(std::move(soup), vertices, scratch);
}

TriangleSoup drop_repetitions(TriangleSoup soup, const std::vector<std::int32_t>& repetitions) {
  for (const auto t : repetitions) soup.repairs.duplicate_triangles.push_back(input_index(soup.input_triangle, t));
  return without_triangles(std::move(soup), repetitions);
}

}  // namespace pectinate::detail
