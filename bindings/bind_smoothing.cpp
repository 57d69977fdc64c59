// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include <optional>

#include "arrays.hpp"
#include "module.hpp"
#include "pectinate/smoothing.hpp"

namespace pectinate::bindings {
namespace {

constexpr auto smoothing_doc = R"(A smoothed field.

Attributes
----------
field : OrientationField
moved_angles : (T,) float64
    Radians in [0, pi/2], per mesh triangle: how far each fibre was moved; NaN where there was or is none.
outliers : (T,) uint8
    1 where the fibre was replaced by what the others around it say.)";

}  // namespace

void bind_smoothing(py::module_& module) {
  py::class_<Smoothing>(module, "Smoothing", smoothing_doc)
      .def_property_readonly("field", [](const Smoothing& result) { return result.field; })
      .def_property_readonly("moved_angles", viewed<Smoothing>(&Smoothing::moved_angles))
      .def_property_readonly("outliers", viewed<Smoothing>(&Smoothing::outliers));
  const SmoothingOptions defaults;
  module.def(
      "smooth",
      [](const SurfaceMesh& mesh, const OrientationField& field, double length, double outlier_angle, bool fill_missing,
         const std::optional<std::vector<std::int32_t>>& barriers) {
        const py::gil_scoped_release release;
        const std::vector<std::int32_t> none;
        return smooth(mesh, field, {length, outlier_angle, fill_missing}, barriers ? *barriers : none);
      },
      py::arg("mesh"), py::arg("field"), py::kw_only(), py::arg("length") = defaults.length,
      py::arg("outlier_angle") = defaults.outlier_angle, py::arg("fill_missing") = defaults.fill_missing,
      py::arg("barriers") = py::none(),
      "Robust smoothing of a measured field. `barriers`: one int a mesh triangle; nothing passes where they differ.");
}

}  // namespace pectinate::bindings
