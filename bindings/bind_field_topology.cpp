// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "module.hpp"
#include "pectinate/field_topology.hpp"

namespace pectinate::bindings {
namespace {

constexpr auto singularity_doc =
    "A vertex around which a field turns: vertex (of the mesh), half_turns (twice its index: 1 where lines bend round "
    "a "
    "point, -1 for a triradius, 2 for a vortex), position (3,).";

constexpr auto topology_doc = R"(Where a field is singular, and how it turns along the boundary loops.

On every orientable component, all of whose triangles have a direction, the half turns of singularities and loops add up
to twice the Euler characteristic.

Attributes
----------
singularities : list of Singularity
    Ascending by vertex; none at the border or at triangles without a direction.
loop_half_turns : list of int or None
    Per boundary loop, of its tangent against the field; 0 for fibres parallel or perpendicular to it, None where a
    triangle along it has no direction.)";

}  // namespace

void bind_field_topology(py::module_& module) {
  py::class_<Singularity>(module, "Singularity", singularity_doc)
      .def_readonly("vertex", &Singularity::vertex)
      .def_readonly("half_turns", &Singularity::half_turns)
      .def_readonly("position", &Singularity::position);
  py::class_<FieldTopology>(module, "FieldTopology", topology_doc)
      .def_readonly("singularities", &FieldTopology::singularities)
      .def_readonly("loop_half_turns", &FieldTopology::loop_half_turns);
  const auto released = py::call_guard<py::gil_scoped_release>();
  module.def("field_topology", &field_topology, released, py::arg("mesh"), py::arg("field"),
             "Count the singularities of a field, by the least turns between neighbouring triangles.");
  module.def(
      "dirichlet_energy", &dirichlet_energy, released, py::arg("mesh"), py::arg("field"),
      "How much a field varies: half the sum over inner edges of |z - neighbour's z|^2, z = exp(2 i theta), times "
      "the edge's length over the distance of the circumcentres. No unit.");
}

}  // namespace pectinate::bindings
