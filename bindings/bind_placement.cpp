// SPDX-License-Identifier: MIT
#include <pybind11/native_enum.h>
#include <pybind11/stl.h>

#include <utility>

#include "arrays.hpp"
#include "module.hpp"
#include "pectinate/placement.hpp"

namespace pectinate::bindings {
namespace {

/// The user's callback, called with the GIL held; an exception in it, or Ctrl-C, ends the placement.
std::function<bool(double)> with_signals(const py::object& progress) {
  return [&progress](double coverage) {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (progress.is_none()) return true;
    const py::object go_on = progress(coverage);
    return go_on.is_none() || go_on.cast<bool>();
  };
}

void bind_enumerations(py::module_& module) {
  py::native_enum<PlacementMethod>(module, "PlacementMethod", "enum.Enum")
      .value("random", PlacementMethod::random)
      .value("neighborhood", PlacementMethod::neighborhood)
      .value("distance", PlacementMethod::distance)
      .value("longest", PlacementMethod::longest)
      .finalize();
  py::native_enum<OccupancyModel>(module, "OccupancyModel", "enum.Enum")
      .value("exact", OccupancyModel::exact)
      .value("edge_mask", OccupancyModel::edge_mask)
      .finalize();
  py::native_enum<PlacementEnd>(module, "PlacementEnd", "enum.Enum")
      .value("complete", PlacementEnd::complete)
      .value("cancelled", PlacementEnd::cancelled)
      .finalize();
  py::native_enum<StopReason>(module, "StopReason", "enum.IntEnum")
      .value("max_steps", StopReason::max_steps)
      .value("boundary", StopReason::boundary)
      .value("near_other", StopReason::near_other)
      .value("abrupt_turn", StopReason::abrupt_turn)
      .value("near_itself", StopReason::near_itself)
      .value("no_field", StopReason::no_field)
      .value("closed", StopReason::closed)
      .value("singularity", StopReason::singularity)
      .finalize();
}

void bind_statistics(py::module_& module) {
  using Statistics = PlacementStatistics;
  py::class_<Statistics>(module, "PlacementStatistics")
      .def_readonly("streamline_count", &Statistics::streamline_count)
      .def_readonly("total_length", &Statistics::total_length)
      .def_readonly("mean_length", &Statistics::mean_length)
      .def_readonly("length_weighted_mean", &Statistics::length_weighted_mean)
      .def_readonly("surface_area", &Statistics::surface_area)
      .def_readonly("mean_spacing", &Statistics::mean_spacing)
      .def_readonly("mean_spacing_ratio", &Statistics::mean_spacing_ratio)
      .def_readonly("short_fraction", &Statistics::short_fraction)
      .def_readonly("coverage", &Statistics::coverage)
      .def_readonly("stop_counts", &Statistics::stop_counts)
      .def_readonly("polishing_rounds", &Statistics::polishing_rounds);
  module.def(
      "length_histogram",
      [](const py::array_t<double, py::array::c_style | py::array::forcecast>& lengths, int bin_count) {
        auto [edges, counts] = length_histogram({lengths.data(), static_cast<std::size_t>(lengths.size())}, bin_count);
        return std::pair{py::array_t<double>(static_cast<py::ssize_t>(edges.size()), edges.data()),
                         py::array_t<std::int64_t>(static_cast<py::ssize_t>(counts.size()), counts.data())};
      },
      py::arg("lengths"), py::arg("bin_count"));
}

void bind_result(py::module_& module) {
  py::class_<PlacementOptions>(module, "PlacementOptions")
      .def(py::init<>())
      .def_readonly("separation_distance", &PlacementOptions::separation_distance)
      .def_readonly("method", &PlacementOptions::method)
      .def_readonly("occupancy", &PlacementOptions::occupancy)
      .def_readonly("seed_count", &PlacementOptions::seed_count)
      .def_readonly("seed_distance_factor", &PlacementOptions::seed_distance_factor)
      .def_readonly("seed_clearance", &PlacementOptions::seed_clearance)
      .def_readonly("test_distance", &PlacementOptions::test_distance)
      .def_readonly("minimum_length", &PlacementOptions::minimum_length)
      .def_readonly("close_loops", &PlacementOptions::close_loops)
      .def_readonly("singularity_radius", &PlacementOptions::singularity_radius)
      .def_readonly("polishing_rounds", &PlacementOptions::polishing_rounds)
      .def_readonly("polishing_time", &PlacementOptions::polishing_time)
      .def_readonly("abrupt_turn_angle", &PlacementOptions::abrupt_turn_angle)
      .def_readonly("max_steps", &PlacementOptions::max_steps)
      .def_readonly("random_seed", &PlacementOptions::random_seed)
      .def_readonly("thread_count", &PlacementOptions::thread_count);
  py::class_<Placement>(module, "Placement")
      .def_property_readonly("points", viewed<Placement>(&Placement::points))
      .def_property_readonly("offsets", viewed<Placement>(&Placement::offsets))
      .def_property_readonly("segment_triangles", viewed<Placement>(&Placement::segment_triangles))
      .def_property_readonly("point_triangles", viewed<Placement>(&Placement::point_triangles))
      .def_property_readonly("barycentric", viewed<Placement>(&Placement::barycentric))
      .def_property_readonly("lengths", viewed<Placement>(&Placement::lengths))
      .def_property_readonly("stop_reasons", viewed<Placement>(&Placement::stop_reasons))
      .def_property_readonly("seed_points", viewed<Placement>(&Placement::seed_points))
      .def_readonly("statistics", &Placement::statistics)
      .def_readonly("options", &Placement::options)
      .def_readonly("end", &Placement::end);
}

void bind_types(py::module_& module) {
  bind_enumerations(module);
  bind_statistics(module);
  bind_result(module);
}

/// Every option is an argument of its own, and so a misspelt one an error.
constexpr auto place = [](const SurfaceMesh& mesh, const OrientationField& field, double separation_distance,
                          std::vector<double> separation_distances, PlacementMethod method, OccupancyModel occupancy,
                          int seed_count, double seed_distance_factor, double seed_clearance, double test_distance,
                          double minimum_length, bool close_loops, double singularity_radius,
                          std::int64_t polishing_rounds, double polishing_time, double abrupt_turn_angle,
                          std::int64_t max_steps, std::uint64_t random_seed, int thread_count,
                          const py::object& progress) {
  const PlacementOptions options{separation_distance,
                                 std::move(separation_distances),
                                 method,
                                 occupancy,
                                 seed_count,
                                 seed_distance_factor,
                                 seed_clearance,
                                 test_distance,
                                 minimum_length,
                                 close_loops,
                                 singularity_radius,
                                 polishing_rounds,
                                 polishing_time,
                                 abrupt_turn_angle,
                                 max_steps,
                                 random_seed,
                                 thread_count,
                                 with_signals(progress)};
  const py::gil_scoped_release release;
  return place_streamlines(mesh, field, options);
};

}  // namespace

void bind_placement(py::module_& module) {
  bind_types(module);
  const PlacementOptions defaults;
  module.def("place_streamlines", place, py::arg("mesh"), py::arg("field"), py::kw_only(),
             py::arg("separation_distance") = defaults.separation_distance,
             py::arg("separation_distances") = defaults.separation_distances, py::arg("method") = defaults.method,
             py::arg("occupancy") = defaults.occupancy, py::arg("seed_count") = defaults.seed_count,
             py::arg("seed_distance_factor") = defaults.seed_distance_factor,
             py::arg("seed_clearance") = defaults.seed_clearance, py::arg("test_distance") = defaults.test_distance,
             py::arg("minimum_length") = defaults.minimum_length, py::arg("close_loops") = defaults.close_loops,
             py::arg("singularity_radius") = defaults.singularity_radius,
             py::arg("polishing_rounds") = defaults.polishing_rounds,
             py::arg("polishing_time") = defaults.polishing_time,
             py::arg("abrupt_turn_angle") = defaults.abrupt_turn_angle, py::arg("max_steps") = defaults.max_steps,
             py::arg("random_seed") = defaults.random_seed, py::arg("thread_count") = defaults.thread_count,
             py::arg("progress") = py::none());
}

}  // namespace pectinate::bindings
