// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include <string>

#include "arrays.hpp"
#include "module.hpp"
#include "pectinate/reference_frame.hpp"

namespace pectinate::bindings {
namespace {

constexpr auto frame_doc =
    R"(A reference field that vanishes nowhere, and its local basis; made by `make_reference_frame`.

Attributes
----------
u : (V,) float64
    Per mesh vertex, in [0, 1]; NaN on fragments.
longitudinal, transverse : (T, 3) float64
    Unit vectors per mesh triangle: e_l, the direction of the gradient of u on the surface, and e_t = n x e_l.
borrowed_triangles : (n,) int32
    Triangles on which u is constant: they have the frame of a neighbour, turned into their plane about the common edge.
    Those of fragments too.
critical_points : (n, 2) int32
    Interior vertices at which u has a critical point, and its index: 1 for an extremum, -1 and below for saddles. Empty
    for a usable frame.)";

constexpr auto make_doc = R"(Make a reference frame of a parameterized surface.

Solves Laplace's equation on the disk, u = 1 on the circle and 0 on the inner loop or point, with positive mean value
weights. With neither, u = (1 + x) / 2 of the disk.

Parameters
----------
mesh : SurfaceMesh
parameterization : Parameterization
    Of this mesh.
inner_loop : int, optional
    Index into `mesh.boundary_loops`, such as that of the fossa ovalis.
inner_point : (3,) float, optional
    Where there is no such loop: u = 0 at the mapped vertex nearest to this point. In the unit of the mesh.

Raises
------
InvalidOption
    The parameterization is of another mesh; the loop does not exist, is the outer one or bounds a fragment; the point is
    not finite or nearest to the outer loop; both are given.
SolverFailure)";

constexpr auto angles_doc = R"(The angle of a field in a frame: equation (1).

Returns
-------
(T,) float64
    Per mesh triangle, radians in (-pi/2, pi/2]; NaN where the field has no direction.

Raises
------
InvalidField
    The field is on another number of triangles.)";

constexpr auto field_doc = R"(The field that has given angles in a frame: equation (2).

Parameters
----------
mesh : SurfaceMesh
frame : ReferenceFrame
angles : (T,) float
    Per mesh triangle, radians, any branch; NaN: no direction.

Raises
------
InvalidField
    A wrong count, or no angle is finite.)";

std::vector<double> to_angles(const py::array& array) {
  if (std::string("fiu").find(array.dtype().kind()) == std::string::npos) {
    throw py::type_error("angles must hold real numbers, not " + std::string(py::str(array.dtype().attr("name"))));
  }
  if (array.ndim() != 1) {
    throw py::value_error("angles has the shape " + std::string(py::str(array.attr("shape"))) +
                          ", but must have one dimension: (T,)");
  }
  const py::array_t<double, py::array::c_style | py::array::forcecast> numbers(array);
  return {numbers.data(), numbers.data() + numbers.size()};
}

py::array critical_points(py::object self) {
  const auto& points = self.cast<const ReferenceFrame&>().critical_points;
  static_assert(sizeof(CriticalPoint) == 2 * sizeof(std::int32_t));
  return read_only_view(std::array{static_cast<py::ssize_t>(points.size()), py::ssize_t{2}},
                        reinterpret_cast<const std::int32_t*>(points.data()), self);
}

}  // namespace

void bind_reference_frame(py::module_& module) {
  py::class_<ReferenceFrame>(module, "ReferenceFrame", frame_doc)
      .def_property_readonly("u", viewed<ReferenceFrame>(&ReferenceFrame::u))
      .def_property_readonly("longitudinal", viewed<ReferenceFrame>(&ReferenceFrame::longitudinal))
      .def_property_readonly("transverse", viewed<ReferenceFrame>(&ReferenceFrame::transverse))
      .def_property_readonly("borrowed_triangles", viewed<ReferenceFrame>(&ReferenceFrame::borrowed_triangles))
      .def_property_readonly("critical_points", &critical_points);
  const ReferenceFrameOptions defaults;
  module.def(
      "make_reference_frame",
      [](const SurfaceMesh& mesh, const Parameterization& parameterization, std::optional<std::int32_t> inner_loop,
         std::optional<Vec3> inner_point) {
        const py::gil_scoped_release release;
        return make_reference_frame(mesh, parameterization, {inner_loop, inner_point});
      },
      make_doc, py::arg("mesh"), py::arg("parameterization"), py::kw_only(),
      py::arg("inner_loop") = defaults.inner_loop, py::arg("inner_point") = defaults.inner_point);
  module.def(
      "field_angles",
      [](const ReferenceFrame& frame, const OrientationField& field) {
        std::vector<double> angles;
        {
          const py::gil_scoped_release release;
          angles = field_angles(frame, field);
        }
        return py::array_t<double>(static_cast<py::ssize_t>(angles.size()), angles.data());
      },
      angles_doc, py::arg("frame"), py::arg("field"));
  module.def(
      "field_from_angles",
      [](const SurfaceMesh& mesh, const ReferenceFrame& frame, const py::array& angles) {
        const auto numbers = to_angles(angles);
        const py::gil_scoped_release release;
        return field_from_angles(mesh, frame, numbers);
      },
      field_doc, py::arg("mesh"), py::arg("frame"), py::arg("angles"));
}

}  // namespace pectinate::bindings
