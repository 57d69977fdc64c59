// SPDX-License-Identifier: MIT
#include <pybind11/native_enum.h>
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "module.hpp"
#include "pectinate/atria.hpp"

namespace pectinate::bindings {

void bind_atria(py::module_& module) {
  py::native_enum<AtrialSurface>(module, "AtrialSurface", "enum.Enum")
      .value("left_atrium", AtrialSurface::left_atrium)
      .value("right_atrium", AtrialSurface::right_atrium)
      .value("bachmann_bundle", AtrialSurface::bachmann_bundle)
      .finalize();
  py::native_enum<AtrialLayer>(module, "AtrialLayer", "enum.Enum")
      .value("epicardium", AtrialLayer::epicardium)
      .value("endocardium", AtrialLayer::endocardium)
      .finalize();
  py::class_<GeneratedSurface>(module, "GeneratedSurface")
      .def_property_readonly("vertices", viewed<GeneratedSurface>(&GeneratedSurface::vertices))
      .def_property_readonly("triangles", viewed<GeneratedSurface>(&GeneratedSurface::triangles))
      .def_property_readonly("regions", viewed<GeneratedSurface>(&GeneratedSurface::regions))
      .def_readonly("region_names", &GeneratedSurface::region_names)
      .def_readonly("loops", &GeneratedSurface::loops);
  const AtriaOptions defaults;
  module.def(
      "make_atrial_surface",
      [](AtrialSurface surface, AtrialLayer layer, double edge_length) {
        const py::gil_scoped_release release;
        return make_atrial_surface(surface, layer, {edge_length});
      },
      py::arg("surface"), py::arg("layer") = AtrialLayer::epicardium, py::kw_only(),
      py::arg("edge_length") = defaults.edge_length);
}

}  // namespace pectinate::bindings
