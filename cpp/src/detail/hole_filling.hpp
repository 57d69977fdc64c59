// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "pectinate/surface_mesh.hpp"

namespace pectinate::detail {

/// One component of a surface with all its boundary loops but one closed: a topological disk if its genus is 0.
/// Its vertices are those of the component, in mesh order, then one centre per closed loop.
struct FilledSurface {
  std::vector<std::int32_t> mesh_vertices;    ///< per vertex that is no centre
  std::vector<std::int32_t> filled_vertices;  ///< per mesh vertex; -1 for those of other components
  std::vector<std::int32_t> closed_loops;     ///< per centre, ascending
  std::vector<Triangle> triangles;            ///< those of the component, in mesh order, then the fans

  std::size_t vertex_count() const { return mesh_vertices.size() + closed_loops.size(); }
  std::int32_t centre(std::size_t hole) const { return static_cast<std::int32_t>(mesh_vertices.size() + hole); }
};

/// Closes the loops of the component on which the outer loop lies by fans to a new vertex each. A fan has no triangle
/// that is flat by its topology, whatever the shape of the hole, slits included.
FilledSurface fill_holes(const SurfaceMesh& mesh, std::int32_t outer_loop);

/// What is known per mesh vertex and per boundary loop, as rows per vertex of the filled surface.
template <class Value>
std::vector<Value> on_filled(const FilledSurface& filled, const std::vector<Value>& per_vertex,
                             const std::vector<Value>& per_loop) {
  std::vector<Value> values;
  values.reserve(filled.vertex_count());
  for (const auto v : filled.mesh_vertices) values.push_back(per_vertex[v]);
  for (const auto loop : filled.closed_loops) values.push_back(per_loop[loop]);
  return values;
}

}  // namespace pectinate::detail
