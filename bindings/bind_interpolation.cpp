// SPDX-License-Identifier: MIT
#include "arrays.hpp"
#include "module.hpp"
#include "pectinate/interpolation.hpp"

namespace pectinate::bindings {
namespace {

constexpr auto interpolation_doc = R"(A field made of constraints.

Attributes
----------
field : OrientationField
confidence : (T,) float64
    In [0, 1], per mesh triangle: the magnitude of the interpolated phase exp(2 i theta). Near 0 around singularities and
    where constraints disagree; small too, on curved surfaces, where only weak weights act.)";

constexpr auto interpolator_doc = R"(Interpolates orientations over a surface: the smoothest phase under constraints.

Keeps its factorization, so that an edit of some constraints costs far less than a new interpolator, and gives the same
bytes. Not for several threads at once.

Parameters
----------
mesh : SurfaceMesh
frame : ReferenceFrame, optional
    Interpolate the angle in this frame, as the paper does. Without, phases are carried from triangle to triangle by
    unfolding them (the Levi-Civita connection): any surface. A component without constraints gets its smoothest field.

Raises
------
InvalidField
    A frame of another mesh.)";

constexpr auto interpolate_doc = R"(The field under these constraints; hard ones are met exactly.

Raises
------
InvalidField
    Constraints of another mesh, or a weight out of its range.)";

FieldInterpolator make(const SurfaceMesh& mesh, const ReferenceFrame* frame) {
  const py::gil_scoped_release release;
  return frame == nullptr ? FieldInterpolator(mesh) : FieldInterpolator(mesh, *frame);
}

}  // namespace

void bind_interpolation(py::module_& module) {
  py::class_<Interpolation>(module, "Interpolation", interpolation_doc)
      .def_property_readonly("field", [](const Interpolation& result) { return result.field; })
      .def_property_readonly("confidence", viewed<Interpolation>(&Interpolation::confidence));
  py::class_<FieldInterpolator>(module, "FieldInterpolator", interpolator_doc)
      .def(py::init(&make), py::arg("mesh"), py::arg("frame") = nullptr, py::keep_alive<1, 2>())
      .def(
          "interpolate",
          [](FieldInterpolator& interpolator, const Constraints& constraints) {
            const py::gil_scoped_release release;
            return interpolator.interpolate(constraints.triangles);
          },
          interpolate_doc, py::arg("constraints"));
}

}  // namespace pectinate::bindings
