// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "module.hpp"
#include "pectinate/surface_mesh.hpp"

namespace pectinate::bindings {
namespace {

constexpr auto mesh_doc = R"(A triangulated surface made of any triangle soup; immutable.

It is cut open where it is no manifold, consistently oriented where it can be, outwards where there is an outside.
Kept triangles stay in input order; `repairs` lists what was changed. Arrays are read-only views; `edge_lengths`,
`triangle_normals`, `input_vertex` and `input_triangle` are computed at every access, so keep them while you need them.

Parameters
----------
vertices : (V_in, 3) float
    In any unit of length; millimetres in the rest of pectinate.
triangles : (T_in, 3) int
    Indices of vertices.

Raises
------
InvalidMesh
    An index is out of range, or no valid triangle is left.

Attributes
----------
vertices : (V, 3) float64
triangles : (T, 3) int32
input_vertex, input_triangle : (V,) and (T,) int32
    The input's index of each vertex and triangle.
edges : (E, 2) int32
    End vertices. An edge is geometric: it is one, also where the surface was cut.
edge_lengths : (E,) float64
triangle_areas, triangle_normals, triangle_components : (T,), (T, 3) unit, (T,) int32
components : list of SurfaceComponent
boundary_loops : list of BoundaryLoop
    Longest first.
repairs : MeshRepairs)";

constexpr auto repairs_doc = "What was changed to make a surface; int32 arrays of the input's indices.";
constexpr auto loop_doc =
    "A closed border: vertices (n,) in order, length, diameter (of the bounding box), centroid, component.";
constexpr auto component_doc =
    "A maximal set of joined triangles: triangle_count, area, euler_characteristic, boundary_loop_count, orientable, "
    "genus (cross-caps when not orientable).";

void bind_parts(py::module_& module) {
  py::class_<MeshRepairs>(module, "MeshRepairs", repairs_doc)
      .def_property_readonly("degenerate_triangles", viewed<MeshRepairs>(&MeshRepairs::degenerate_triangles))
      .def_property_readonly("duplicate_triangles", viewed<MeshRepairs>(&MeshRepairs::duplicate_triangles))
      .def_property_readonly("non_finite_vertices", viewed<MeshRepairs>(&MeshRepairs::non_finite_vertices))
      .def_property_readonly("non_finite_triangles", viewed<MeshRepairs>(&MeshRepairs::non_finite_triangles))
      .def_property_readonly("unreferenced_vertices", viewed<MeshRepairs>(&MeshRepairs::unreferenced_vertices))
      .def_property_readonly("reversed_triangles", viewed<MeshRepairs>(&MeshRepairs::reversed_triangles))
      .def_property_readonly("non_manifold_edges", viewed<MeshRepairs>(&MeshRepairs::non_manifold_edges))
      .def_property_readonly("split_vertices", viewed<MeshRepairs>(&MeshRepairs::split_vertices));
  py::class_<BoundaryLoop>(module, "BoundaryLoop", loop_doc)
      .def_property_readonly("vertices", viewed<BoundaryLoop>(&BoundaryLoop::vertices))
      .def_readonly("length", &BoundaryLoop::length)
      .def_readonly("diameter", &BoundaryLoop::diameter)
      .def_readonly("centroid", &BoundaryLoop::centroid)
      .def_readonly("component", &BoundaryLoop::component);
  py::class_<SurfaceComponent>(module, "SurfaceComponent", component_doc)
      .def_readonly("triangle_count", &SurfaceComponent::triangle_count)
      .def_readonly("area", &SurfaceComponent::area)
      .def_readonly("euler_characteristic", &SurfaceComponent::euler_characteristic)
      .def_readonly("boundary_loop_count", &SurfaceComponent::boundary_loop_count)
      .def_readonly("orientable", &SurfaceComponent::orientable)
      .def_readonly("genus", &SurfaceComponent::genus);
}

SurfaceMesh make_mesh(const py::array& vertices, const py::array& triangles) {
  const Rows<3> points(vertices, "vertices");
  const auto corners = to_triangles(triangles);
  const py::gil_scoped_release release;
  return SurfaceMesh(points.span(), corners);
}

}  // namespace

void bind_surface_mesh(py::module_& module) {
  bind_parts(module);
  py::class_<SurfaceMesh>(module, "SurfaceMesh", mesh_doc)
      .def(py::init(&make_mesh), py::arg("vertices"), py::arg("triangles"))
      .def_property_readonly("vertices", viewed<SurfaceMesh>(&SurfaceMesh::vertices))
      .def_property_readonly("triangles", viewed<SurfaceMesh>(&SurfaceMesh::triangles))
      .def_property_readonly("triangle_count", &SurfaceMesh::triangle_count)
      .def_property_readonly("input_vertex_count", &SurfaceMesh::input_vertex_count)
      .def_property_readonly("input_triangle_count", &SurfaceMesh::input_triangle_count)
      .def_property_readonly("input_vertex", viewed<SurfaceMesh>(&SurfaceMesh::input_vertex))
      .def_property_readonly("input_triangle", viewed<SurfaceMesh>(&SurfaceMesh::input_triangle))
      .def_property_readonly("repairs", &SurfaceMesh::repairs)
      .def_property_readonly("edges", viewed<SurfaceMesh>(&SurfaceMesh::edges))
      .def_property_readonly("edge_lengths", viewed<SurfaceMesh>(&SurfaceMesh::edge_lengths))
      .def_property_readonly("triangle_areas", viewed<SurfaceMesh>(&SurfaceMesh::triangle_areas))
      .def_property_readonly("triangle_normals", viewed<SurfaceMesh>(&SurfaceMesh::triangle_normals))
      .def_property_readonly("triangle_components", viewed<SurfaceMesh>(&SurfaceMesh::triangle_components))
      .def_property_readonly("area", &SurfaceMesh::area)
      .def_property_readonly("bounding_box_diagonal", &SurfaceMesh::bounding_box_diagonal)
      .def_property_readonly("components", &SurfaceMesh::components)
      .def_property_readonly("boundary_loops", &SurfaceMesh::boundary_loops);
}

}  // namespace pectinate::bindings
