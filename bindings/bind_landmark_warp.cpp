// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "module.hpp"
#include "pectinate/landmark_warp.hpp"

namespace pectinate::bindings {
namespace {

constexpr auto warp_doc = R"(A smooth map of space that takes landmarks to landmarks; by `make_landmark_warp`.

Of all such maps the one that bends least, the thin-plate spline of three dimensions:
x -> linear x + offset + the sum over landmarks of |x - landmark| weight.

Attributes
----------
landmarks, weights : (n, 3) float64
linear : list of three rows of three floats
offset : list of three floats)";

constexpr auto make_doc = R"(Make the map that takes landmarks to their counterparts.

Affine maps are reproduced. The order of the landmarks means nothing.

Parameters
----------
landmarks, counterparts : (n, 3)
    At least four, not in one plane; landmarks in different places.
stiffness : float
    0: exactly. More, and the map stays closer to an affine one; without unit.

Raises
------
InvalidOption
    Landmarks too few, in one plane, twice in one place or not finite, other counts, a stiffness that is negative or not
    finite, or landmarks whose map would turn space inside out: names of left and right are then exchanged.)";

constexpr auto points_doc = R"(Where points (n, 3) go, (n, 3) float64.

Raises
------
InvalidOption
    A point is not finite.)";

}  // namespace

void bind_landmark_warp(py::module_& module) {
  py::class_<LandmarkWarp>(module, "LandmarkWarp", warp_doc)
      .def_property_readonly("landmarks", viewed<LandmarkWarp>(&LandmarkWarp::landmarks))
      .def_property_readonly("weights", viewed<LandmarkWarp>(&LandmarkWarp::weights))
      .def_readonly("linear", &LandmarkWarp::linear)
      .def_readonly("offset", &LandmarkWarp::offset);
  const WarpOptions defaults;
  module.def(
      "make_landmark_warp",
      [](const py::array& landmarks, const py::array& counterparts, double stiffness) {
        const Rows<3> from(landmarks, "landmarks"), to(counterparts, "counterparts");
        const py::gil_scoped_release release;
        return make_landmark_warp(from.span(), to.span(), {stiffness});
      },
      make_doc, py::arg("landmarks"), py::arg("counterparts"), py::kw_only(),
      py::arg("stiffness") = defaults.stiffness);
  module.def(
      "warp_points",
      [](const LandmarkWarp& warp, const py::array& points) {
        const Rows<3> rows(points, "points");
        const auto moved = [&] {
          const py::gil_scoped_release release;
          return warp_points(warp, rows.span());
        }();
        return py::array_t<double>({static_cast<py::ssize_t>(moved.size()), py::ssize_t{3}}, moved.data()->data());
      },
      points_doc, py::arg("warp"), py::arg("points"));
}

}  // namespace pectinate::bindings
