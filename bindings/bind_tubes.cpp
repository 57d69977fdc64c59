// SPDX-License-Identifier: MIT
#include "arrays.hpp"
#include "module.hpp"
#include "pectinate/tubes.hpp"

namespace pectinate::bindings {

void bind_tubes(py::module_& module) {
  py::class_<Tubes>(
      module, "Tubes",
      "Closed tubes, one per streamline: vertices (N, 3) float64, triangles (M, 3) int32, counter-clockwise seen from "
      "outside; vertex_offsets and triangle_offsets (n + 1,) int64 part them by streamline; vertex_points (N,) "
      "float64: "
      "the point of the placement that each vertex is at, and the share of the way to the next one.")
      .def_property_readonly("vertices", viewed<Tubes>(&Tubes::vertices))
      .def_property_readonly("triangles", viewed<Tubes>(&Tubes::triangles))
      .def_property_readonly("vertex_offsets", viewed<Tubes>(&Tubes::vertex_offsets))
      .def_property_readonly("triangle_offsets", viewed<Tubes>(&Tubes::triangle_offsets))
      .def_property_readonly("vertex_points", viewed<Tubes>(&Tubes::vertex_points));
  const TubeOptions defaults;
  module.attr("default_taper_length") = defaults.taper_length;
  module.def(
      "make_tubes",
      [](const SurfaceMesh& mesh, const Placement& placement, double radius, double taper_length, int side_count,
         double height) {
        const py::gil_scoped_release release;
        return make_tubes(mesh, placement, {radius, taper_length, side_count, height});
      },
      py::arg("mesh"), py::arg("placement"), py::kw_only(), py::arg("radius") = defaults.radius,
      py::arg("taper_length") = defaults.taper_length, py::arg("side_count") = defaults.side_count,
      py::arg("height") = defaults.height);
}

}  // namespace pectinate::bindings
