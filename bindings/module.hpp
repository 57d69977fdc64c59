// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

namespace pectinate::bindings {

void bind_errors(pybind11::module_& module);
void bind_surface_mesh(pybind11::module_& module);
void bind_orientation_field(pybind11::module_& module);
void bind_constraints(pybind11::module_& module);
void bind_parameterization(pybind11::module_& module);
void bind_reference_frame(pybind11::module_& module);
void bind_placement(pybind11::module_& module);
void bind_tubes(pybind11::module_& module);
void bind_field_topology(pybind11::module_& module);
void bind_interpolation(pybind11::module_& module);
void bind_smoothing(pybind11::module_& module);
void bind_comparison(pybind11::module_& module);
void bind_demo_atrium(pybind11::module_& module);
void bind_atria(pybind11::module_& module);
void bind_landmark_warp(pybind11::module_& module);

}  // namespace pectinate::bindings
