// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "module.hpp"
#include "pectinate/comparison.hpp"

namespace pectinate::bindings {
namespace {

constexpr auto angles_doc = R"(The angle between the two lines of each triangle.

Parameters
----------
first, second : OrientationField
    On one mesh.

Returns
-------
(T,) float64
    Radians in [0, pi/2], per mesh triangle; NaN where either field has no direction.

Raises
------
InvalidField
    The fields are on different numbers of triangles.)";

constexpr auto noise_doc = R"(Turn every direction in its triangle's plane by a normal random angle of mean 0.

Parameters
----------
mesh : SurfaceMesh
field : OrientationField
    On this mesh.
standard_deviation : float
    Of the angle, radians in [0, pi].
random_seed : int
    The same seed gives the same noise, triangle by triangle, whatever the field.

Raises
------
InvalidField
    The field is on another number of triangles.
InvalidOption
    The standard deviation is out of its range.)";

constexpr auto vertex_doc = R"(The field per vertex, for solvers that want it so.

Returns
-------
(V, 3) float64
    Per mesh vertex the principal direction of the area-weighted sum of v v^T over the triangles around it. Unit; zero
    where no triangle around has a direction, or they prefer none. The sign means nothing.

Raises
------
InvalidField
    The field is on another number of triangles.)";

constexpr auto transfer_doc = R"(A field carried to another surface; by `transfer_by_nearest_point` or
`transfer_through_disks`.

Attributes
----------
field : OrientationField
    On the target. A triangle whose counterpart has no direction has none.
source_triangles : (T,) int32
    Per target triangle, the one of the source that its direction is from; -1 where there is no counterpart.
distances : (T,) float64
    In space, from the target triangle's centre to its counterpart, in the unit of the meshes; NaN where there is
    none.)";

constexpr auto nearest_doc = R"(Carry a field to another surface in the same place.

Every target triangle gets the field at the point of the source nearest to its centre, turned by the smallest rotation
between the two planes.

Parameters
----------
source : SurfaceMesh
field : OrientationField
    On the source.
target : SurfaceMesh
maximum_distance : float
    Positive, in the unit of the meshes: triangles farther away get none. Infinity: all get one.

Raises
------
InvalidField
    The field is on another number of triangles, or no target triangle gets a direction.
InvalidOption
    The distance is not positive, or the target is farther away than 1e9 diagonals of the source.)";

constexpr auto disks_doc = R"(Carry a field to another surface of the same topology, wherever it is.

Every target triangle gets the field at the point of the source with the same place in the disk, carried by the
differential of the maps; none where that place is in a hole of the source. The disks are first brought together by the
rotation under which the paired loops fit best by the centres of their holes. How well places correspond then depends on
how alike the two maps are, which mean value maps of different meshes are only roughly: look at `distances`.

Parameters
----------
source : SurfaceMesh
source_disk : Parameterization
    Of the source.
field : OrientationField
    On the source.
target : SurfaceMesh
target_disk : Parameterization
    Of the target.
loop_pairs : (n, 2) int
    Indices into `source.boundary_loops` and `target.boundary_loops`; at least one pair of inner loops.

Raises
------
InvalidField
    The field is on another number of triangles, or no target triangle gets a direction.
InvalidOption
    A parameterization is of another mesh; a loop does not exist, bounds a fragment, is given twice or is an outer one
    paired with an inner one; no pair of inner loops, or pairs that fix no rotation.)";

py::array copied(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}
py::array copied(const std::vector<Vec3>& rows) {
  return py::array_t<double>({static_cast<py::ssize_t>(rows.size()), py::ssize_t{3}}, rows.data()->data());
}

/// A new array of what `work` returns, without the interpreter lock while it works.
template <class Work>
py::array array_of(const Work& work) {
  const auto values = [&] {
    const py::gil_scoped_release release;
    return work();
  }();
  return copied(values);
}

}  // namespace

void bind_comparison(py::module_& module) {
  using Mesh = SurfaceMesh;
  using Field = OrientationField;
  py::class_<Transfer>(module, "Transfer", transfer_doc)
      .def_readonly("field", &Transfer::field)
      .def_property_readonly("source_triangles", viewed<Transfer>(&Transfer::source_triangles))
      .def_property_readonly("distances", viewed<Transfer>(&Transfer::distances));
  module.def(
      "angles_between",
      [](const Field& first, const Field& second) { return array_of([&] { return angles_between(first, second); }); },
      angles_doc, py::arg("first"), py::arg("second"));
  const py::call_guard<py::gil_scoped_release> released;
  module.def("add_angular_noise", &add_angular_noise, noise_doc, released, py::arg("mesh"), py::arg("field"),
             py::kw_only(), py::arg("standard_deviation"), py::arg("random_seed") = 1);
  module.def(
      "vertex_directions",
      [](const Mesh& mesh, const Field& field) { return array_of([&] { return vertex_directions(mesh, field); }); },
      vertex_doc, py::arg("mesh"), py::arg("field"));
  module.def("transfer_by_nearest_point", &transfer_by_nearest_point, nearest_doc, released, py::arg("source"),
             py::arg("field"), py::arg("target"), py::kw_only(), py::arg("maximum_distance"));
  module.def("transfer_through_disks", &transfer_through_disks, disks_doc, released, py::arg("source"),
             py::arg("source_disk"), py::arg("field"), py::arg("target"), py::arg("target_disk"), py::kw_only(),
             py::arg("loop_pairs"));
}

}  // namespace pectinate::bindings
