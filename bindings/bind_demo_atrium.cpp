// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "module.hpp"
#include "pectinate/demo_atrium.hpp"

namespace pectinate::bindings {

void bind_demo_atrium(py::module_& module) {
  py::class_<NamedLoop>(module, "NamedLoop")
      .def_readonly("name", &NamedLoop::name)
      .def_property_readonly("vertices", viewed<NamedLoop>(&NamedLoop::vertices));
  py::class_<DemoAtrium>(module, "DemoAtrium")
      .def_property_readonly("vertices", viewed<DemoAtrium>(&DemoAtrium::vertices))
      .def_property_readonly("triangles", viewed<DemoAtrium>(&DemoAtrium::triangles))
      .def_property_readonly("directions", viewed<DemoAtrium>(&DemoAtrium::directions))
      .def_property_readonly("regions", viewed<DemoAtrium>(&DemoAtrium::regions))
      .def_readonly("region_names", &DemoAtrium::region_names)
      .def_readonly("loops", &DemoAtrium::loops);
  const DemoAtriumOptions defaults;
  module.def(
      "make_demo_atrium",
      [](double edge_length) {
        const py::gil_scoped_release release;
        return make_demo_atrium({edge_length});
      },
      py::kw_only(), py::arg("edge_length") = defaults.edge_length);
}

}  // namespace pectinate::bindings
