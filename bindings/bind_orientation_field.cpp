// SPDX-License-Identifier: MIT
#include <pybind11/native_enum.h>

#include "arrays.hpp"
#include "module.hpp"
#include "pectinate/orientation_field.hpp"

namespace pectinate::bindings {
namespace {

constexpr auto field_doc = R"(A line without a sign in every triangle of a mesh, or none where the input gives none.

Made by `from_triangle_vectors(mesh, (T_in, 3))`, `from_vertex_vectors(mesh, (V_in, 3))`,
`from_triangle_tensors(mesh, (T_in, 6))` or `from_vertex_tensors(mesh, (V_in, 6))`; rows follow the mesh's INPUT, tensors
are xx, yy, zz, xy, yz, xz. Directions are projected on their triangle; reversing any vector changes nothing. They raise
InvalidField for a wrong count or when no triangle gets a direction.

Attributes
----------
directions : (T, 3) float64
    Unit, per mesh triangle; zero where there is none.
status : (T,) uint8
    A `DirectionStatus` each.
out_of_plane_angles : (T,) float64
    Radians: how far the input vector stood out of the plane; 0 for tensors and averages.)";

/// Wraps a maker of fields from rows of numbers.
template <std::size_t Columns>
auto from_rows(OrientationField (*make)(const SurfaceMesh&, std::span<const std::array<double, Columns>>),
               const char* name) {
  return [make, name](const SurfaceMesh& mesh, const py::array& array) {
    const Rows<Columns> rows(array, name);
    const py::gil_scoped_release release;
    return make(mesh, rows.span());
  };
}

}  // namespace

void bind_orientation_field(py::module_& module) {
  py::native_enum<DirectionStatus>(module, "DirectionStatus", "enum.IntEnum")
      .value("valid", DirectionStatus::valid)
      .value("zero", DirectionStatus::zero)
      .value("non_finite", DirectionStatus::non_finite)
      .value("normal", DirectionStatus::normal)
      .value("isotropic", DirectionStatus::isotropic)
      .finalize();
  using Field = OrientationField;
  const auto mesh = py::arg("mesh"), vectors = py::arg("vectors"), tensors = py::arg("tensors");
  py::class_<Field>(module, "OrientationField", field_doc)
      .def_static("from_triangle_vectors", from_rows<3>(&Field::from_triangle_vectors, "vectors"), mesh, vectors)
      .def_static("from_vertex_vectors", from_rows<3>(&Field::from_vertex_vectors, "vectors"), mesh, vectors)
      .def_static("from_triangle_tensors", from_rows<6>(&Field::from_triangle_tensors, "tensors"), mesh, tensors)
      .def_static("from_vertex_tensors", from_rows<6>(&Field::from_vertex_tensors, "tensors"), mesh, tensors)
      .def_property_readonly("directions", viewed<Field>(&Field::directions))
      .def_property_readonly("status", viewed<Field>(&Field::status))
      .def_property_readonly("out_of_plane_angles", viewed<Field>(&Field::out_of_plane_angles))
      .def("count", &Field::count, py::arg("status"), "How many triangles have a `DirectionStatus`.");
}

}  // namespace pectinate::bindings
