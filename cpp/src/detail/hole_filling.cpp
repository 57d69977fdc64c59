// SPDX-License-Identifier: MIT
#include "detail/hole_filling.hpp"

namespace pectinate::detail {

FilledSurface fill_holes(const SurfaceMesh& mesh, std::int32_t outer_loop) {
  const auto& loops = mesh.boundary_loops();
  const std::int32_t component = loops[outer_loop].component;
  constexpr std::int32_t elsewhere = -1, used = 0;
  FilledSurface filled{{}, std::vector<std::int32_t>(mesh.vertices().size(), elsewhere), {}, {}};
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (mesh.triangle_components()[t] != component) continue;
    filled.triangles.push_back(mesh.triangles()[t]);
    for (const auto v : mesh.triangles()[t]) filled.filled_vertices[v] = used;
  }
  for (std::size_t v = 0; v < filled.filled_vertices.size(); ++v) {
    if (filled.filled_vertices[v] == elsewhere) continue;
    filled.filled_vertices[v] = static_cast<std::int32_t>(filled.mesh_vertices.size());
    filled.mesh_vertices.push_back(static_cast<std::int32_t>(v));
  }
  for (auto& corners : filled.triangles) {
    for (auto& v : corners) v = filled.filled_vertices[v];
  }
  for (std::int32_t l = 0; l < static_cast<std::int32_t>(loops.size()); ++l) {
    if (l == outer_loop || loops[l].component != component) continue;
    const auto centre = filled.centre(filled.closed_loops.size());
    filled.closed_loops.push_back(l);
    const auto& loop = loops[l].vertices;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      // Loops run with their triangles, so the fan runs against them.
      const auto next = loop[(i + 1) % loop.size()];
      filled.triangles.push_back({centre, filled.filled_vertices[next], filled.filled_vertices[loop[i]]});
    }
  }
  return filled;
}

}  // namespace pectinate::detail
