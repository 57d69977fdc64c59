// SPDX-License-Identifier: MIT
#include <pybind11/native_enum.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>

#include "arrays.hpp"
#include "module.hpp"
#include "pectinate/constraints.hpp"

namespace pectinate::bindings {
namespace {

constexpr auto tract_doc = R"(A fibre tract as drawn: a polyline in space near the surface. Its sense means nothing.

Parameters
----------
points : (n, 3) float
    At least two; the first again at the end closes it. In the unit of the mesh.
name : str
    For messages.
weight : float
    From `LEAST_WEIGHT` to `GREATEST_WEIGHT`, or infinity (the default), which means exactly; 1 pulls about as much as
    one neighbouring triangle.
number : int, optional
    For messages; by default its index among those given.)";

constexpr auto projected_doc = R"(A tract on the surface.

Attributes
----------
points : (n, 3) float64
    The tract's points, brought to the surface, and where the curve between them crosses edges.
triangles : (n - 1,) int32
    Per segment, the mesh triangle that holds it.
greatest_distance : float
    From the tract's given points to the surface.
greatest_detour : float
    Of the curves between given points, the greatest length over the straight distance; far above 1.6 where two points
    lie on either side of a hole or a cut, or one came to the wrong wall.)";

constexpr auto constraints_doc = R"(What tracts and boundary conditions ask of triangles, at most once of each.

Attributes
----------
triangles : (n,) int32
    Of the mesh, ascending.
directions : (n, 3) float64
    Unit, in the triangles' planes; lines without a sign.
weights : (n,) float64
    Infinite where the direction has to be met exactly.
tract_indices : (n,) int32
    The first tract that asks for it, -1 for a boundary condition.
tracts : list of ProjectedTract
    In the order given.
conflict_triangles : (m,) int32
    Where two demands differ by more than `conflict_angle`; ascending.
conflict_tracts : (m, 2) int32
    The tract that was kept and the one that was dropped, -1 for a boundary condition; equal for a tract that crosses
    itself.
conflict_angles : (m,) float64
    Between the two lines, radians.)";

constexpr auto projector_doc = R"(Brings tracts to one surface again and again, as in an editor.

`make_constraints` does the same as the function of that name, but keeps its search tree.)";

constexpr auto make_doc = R"(Bring tracts to a surface and collect what they and its boundary ask of each triangle.

Parameters
----------
mesh : SurfaceMesh
tracts : sequence of Tract
boundary : sequence of BoundaryCondition
maximum_distance : float, optional
    A tract point farther than this from the surface is an error; by default a hundredth of the bounding box's diagonal.
conflict_angle : float
    Radians in (0, pi/2]: two demands on one triangle that differ by more are a conflict; below, they are averaged.

Raises
------
InvalidOption
    Naming the tract or the condition: fewer than two distinct points, a point that is not finite or too far away,
    consecutive points on different components, a loop that does not exist or is given twice, a weight or an option out
    of its range.)";

constexpr auto nearest_doc = R"(The point of the surface nearest to each point.

Parameters
----------
mesh : SurfaceMesh
points : (n, 3) float

Returns
-------
triangles : (n,) int32
    Of equally near ones the first.
points : (n, 3) float64
distances : (n,) float64

Raises
------
InvalidOption
    A point is not finite, or farther away than 1e9 diagonals of the mesh.)";

/// A new array of what `get` finds in every item.
template <class Number, std::size_t Columns, class Item, class Get>
py::array_t<Number> column(const std::vector<Item>& items, const Get& get) {
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(items.size())};
  if (Columns > 1) shape.push_back(static_cast<py::ssize_t>(Columns));
  py::array_t<Number> result(shape);
  Number* next = result.mutable_data();
  for (const auto& item : items) {
    const std::array<Number, Columns> row = get(item);
    next = std::copy(row.begin(), row.end(), next);
  }
  return result;
}

/// The same, read-only, for `def_property_readonly` of Constraints.
template <class Number, std::size_t Columns, class Item, class Get>
auto column_of(std::vector<Item> Constraints::* items, Get get) {
  return [items, get](const Constraints& constraints) {
    auto result = column<Number, Columns>(constraints.*items, get);
    result.attr("setflags")(py::arg("write") = false);
    return result;
  };
}

void bind_input(py::module_& module) {
  py::native_enum<BoundaryRule>(module, "BoundaryRule", "enum.Enum")
      .value("free", BoundaryRule::free)
      .value("parallel", BoundaryRule::parallel)
      .value("perpendicular", BoundaryRule::perpendicular)
      .finalize();
  py::class_<Tract>(module, "Tract", tract_doc)
      .def(py::init([](const py::array& points, std::string name, double weight, std::optional<std::int32_t> number) {
             const Rows<3> rows(points, "points");
             return Tract{std::move(name), {rows.span().begin(), rows.span().end()}, weight, number};
           }),
           py::arg("points"), py::kw_only(), py::arg("name") = "", py::arg("weight") = hard,
           py::arg("number") = py::none())
      .def_readonly("name", &Tract::name)
      .def_property_readonly("points", viewed<Tract>(&Tract::points))
      .def_readonly("weight", &Tract::weight)
      .def_readonly("number", &Tract::number);
  module.attr("LEAST_WEIGHT") = least_weight;
  module.attr("GREATEST_WEIGHT") = greatest_weight;
  py::class_<BoundaryCondition>(module, "BoundaryCondition",
                                "What fibres do at a boundary loop (an index into `mesh.boundary_loops`).")
      .def(py::init([](std::int32_t loop, BoundaryRule rule, double weight) {
             return BoundaryCondition{loop, rule, weight};
           }),
           py::arg("loop"), py::arg("rule"), py::kw_only(), py::arg("weight") = hard)
      .def_readonly("loop", &BoundaryCondition::loop)
      .def_readonly("rule", &BoundaryCondition::rule)
      .def_readonly("weight", &BoundaryCondition::weight);
}

void bind_result(py::module_& module) {
  using Item = TriangleConstraint;
  using Conflict = ConstraintConflict;
  py::class_<ProjectedTract>(module, "ProjectedTract", projected_doc)
      .def_property_readonly("points", viewed<ProjectedTract>(&ProjectedTract::points))
      .def_property_readonly("triangles", viewed<ProjectedTract>(&ProjectedTract::triangles))
      .def_readonly("greatest_distance", &ProjectedTract::greatest_distance)
      .def_readonly("greatest_detour", &ProjectedTract::greatest_detour);
  const auto items = &Constraints::triangles;
  const auto conflicts = &Constraints::conflicts;
  py::class_<Constraints>(module, "Constraints", constraints_doc)
      .def_property_readonly("triangles",
                             column_of<std::int32_t, 1>(items, [](const Item& c) { return std::array{c.triangle}; }))
      .def_property_readonly("directions", column_of<double, 3>(items, [](const Item& c) { return c.direction; }))
      .def_property_readonly("weights", column_of<double, 1>(items, [](const Item& c) { return std::array{c.weight}; }))
      .def_property_readonly("tract_indices",
                             column_of<std::int32_t, 1>(items, [](const Item& c) { return std::array{c.tract}; }))
      .def_readonly("tracts", &Constraints::tracts)
      .def_property_readonly(
          "conflict_triangles",
          column_of<std::int32_t, 1>(conflicts, [](const Conflict& c) { return std::array{c.triangle}; }))
      .def_property_readonly(
          "conflict_tracts",
          column_of<std::int32_t, 2>(conflicts, [](const Conflict& c) { return std::array{c.kept, c.dropped}; }))
      .def_property_readonly("conflict_angles",
                             column_of<double, 1>(conflicts, [](const Conflict& c) { return std::array{c.angle}; }));
}

using Tracts = std::vector<Tract>;
using Conditions = std::vector<BoundaryCondition>;
using Limit = std::optional<double>;

py::tuple as_arrays(const std::vector<SurfacePoint>& nearest) {
  return py::make_tuple(column<std::int32_t, 1>(nearest, [](const SurfacePoint& p) { return std::array{p.triangle}; }),
                        column<double, 3>(nearest, [](const SurfacePoint& p) { return p.point; }),
                        column<double, 1>(nearest, [](const SurfacePoint& p) { return std::array{p.distance}; }));
}

/// Runs `work` without the interpreter lock.
template <class Work>
auto released(const Work& work) {
  const py::gil_scoped_release release;
  return work();
}

void bind_projector(py::module_& module) {
  const ConstraintOptions defaults;
  py::class_<TractProjector>(module, "TractProjector", projector_doc)
      .def(py::init([](const SurfaceMesh& mesh) { return released([&] { return TractProjector(mesh); }); }),
           py::arg("mesh"), py::keep_alive<1, 2>())
      .def(
          "nearest_surface_points",
          [](const TractProjector& projector, const py::array& points) {
            const Rows<3> rows(points, "points");
            return as_arrays(released([&] { return projector.nearest_surface_points(rows.span()); }));
          },
          py::arg("points"))
      .def(
          "make_constraints",
          [](const TractProjector& projector, const Tracts& tracts, const Conditions& boundary, Limit maximum_distance,
             double conflict_angle) {
            return released(
                [&] { return projector.make_constraints(tracts, boundary, {maximum_distance, conflict_angle}); });
          },
          py::arg("tracts"), py::arg("boundary") = Conditions{}, py::kw_only(),
          py::arg("maximum_distance") = defaults.maximum_distance, py::arg("conflict_angle") = defaults.conflict_angle);
}

}  // namespace

void bind_constraints(py::module_& module) {
  bind_input(module);
  bind_result(module);
  bind_projector(module);
  const ConstraintOptions defaults;
  module.def(
      "make_constraints",
      [](const SurfaceMesh& mesh, const Tracts& tracts, const Conditions& boundary, Limit maximum_distance,
         double conflict_angle) {
        return released([&] { return make_constraints(mesh, tracts, boundary, {maximum_distance, conflict_angle}); });
      },
      make_doc, py::arg("mesh"), py::arg("tracts"), py::arg("boundary") = Conditions{}, py::kw_only(),
      py::arg("maximum_distance") = defaults.maximum_distance, py::arg("conflict_angle") = defaults.conflict_angle);
  module.def(
      "nearest_surface_points",
      [](const SurfaceMesh& mesh, const py::array& points) {
        const Rows<3> rows(points, "points");
        return as_arrays(released([&] { return nearest_surface_points(mesh, rows.span()); }));
      },
      nearest_doc, py::arg("mesh"), py::arg("points"));
  module.def(
      "nearest_boundary_loop",
      [](const SurfaceMesh& mesh, const Vec3& point) { return nearest_boundary_loop(mesh, point); }, py::arg("mesh"),
      py::arg("point"),
      "The index of the boundary loop with the point nearest to `point`. InvalidMesh for a closed surface.");
}

}  // namespace pectinate::bindings
