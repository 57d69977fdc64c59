// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "module.hpp"
#include "pectinate/parameterization.hpp"

namespace pectinate::bindings {
namespace {

constexpr auto parameterization_doc = R"(The mean value map of a surface onto the unit disk, made by `parameterize`.

What belongs to fragments, components beside the one that is mapped, has no place in the disk: NaN.

Attributes
----------
points : (V, 2) float64
    Per mesh vertex; those of the outer loop lie on the unit circle.
outer_loop : int
    Index into `mesh.boundary_loops`.
loop_ambiguity : float
    Second longest over longest loop: above 0.8 the choice of the longest says little. 0 with a single loop.
loop_centres : (L, 2) float64
    Per boundary loop, the image of the vertex that closes it as a hole; of the outer loop, the origin.
flipped_triangles : (n,) int32
    Mesh triangles of zero or negative area in the disk.
area_ratio : (T,) float64
    Area in the disk over area on the surface, both as shares of their totals; signed.
anisotropy : (T,) float64
    Greater over smaller singular value of the map, >= 1; infinite for a triangle that is flat in the disk.)";

constexpr auto parameterize_doc = R"(Map a surface onto the unit disk.

All holes but the outer loop are closed by a fan to a new vertex, the outer loop goes to the circle in proportion to its
edge lengths, its first vertex to (1, 0), and every other vertex to the average of its neighbours under mean value
weights (Floater 2003). Seen from outside the surface, the disk is seen from +z.

Parameters
----------
mesh : SurfaceMesh
    One orientable component of genus 0 with a boundary; fragments of at most 1 % of the area are passed over.
outer_loop : int, optional
    Index into `mesh.boundary_loops`; the longest by default.

Raises
------
InvalidMesh
    For any other surface.
InvalidOption
    The loop does not exist or bounds a fragment.
SolverFailure
    The linear system has no solution.
Error
    pectinate was built without CGAL; see `has_parameterization`.)";

/// A read-only view of one member of each row.
template <double TriangleDistortion::* Member>
py::array column(py::object self) {
  const auto& rows = self.cast<const Parameterization&>().distortion;
  const double* first = rows.empty() ? nullptr : &(rows.front().*Member);
  const auto count = static_cast<py::ssize_t>(rows.size());
  py::array_t<double> result({count}, {static_cast<py::ssize_t>(sizeof(TriangleDistortion))}, first, self);
  result.attr("setflags")(py::arg("write") = false);
  return result.attr("view")();
}

}  // namespace

void bind_parameterization(py::module_& module) {
  py::class_<Parameterization>(module, "Parameterization", parameterization_doc)
      .def_property_readonly("points", viewed<Parameterization>(&Parameterization::points))
      .def_readonly("outer_loop", &Parameterization::outer_loop)
      .def_readonly("loop_ambiguity", &Parameterization::loop_ambiguity)
      .def_property_readonly("loop_centres", viewed<Parameterization>(&Parameterization::loop_centres))
      .def_property_readonly("flipped_triangles", viewed<Parameterization>(&Parameterization::flipped_triangles))
      .def_property_readonly("area_ratio", &column<&TriangleDistortion::area_ratio>)
      .def_property_readonly("anisotropy", &column<&TriangleDistortion::anisotropy>);
  module.def("has_parameterization", &has_parameterization,
             "Whether pectinate was built with CGAL, without which there is no parameterization.");
  const ParameterizationOptions defaults;
  module.def(
      "parameterize",
      [](const SurfaceMesh& mesh, std::optional<std::int32_t> outer_loop) {
        const py::gil_scoped_release release;
        return parameterize(mesh, {outer_loop});
      },
      parameterize_doc, py::arg("mesh"), py::kw_only(), py::arg("outer_loop") = defaults.outer_loop);
}

}  // namespace pectinate::bindings
