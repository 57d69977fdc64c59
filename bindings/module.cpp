// SPDX-License-Identifier: MIT
#include "module.hpp"

PYBIND11_MODULE(_core, module) {
  using namespace pectinate::bindings;
  module.doc() = "The compiled engine. Use it through the package pectinate.";
  bind_errors(module);
  bind_surface_mesh(module);
  bind_orientation_field(module);
  bind_field_topology(module);
  bind_parameterization(module);
  bind_reference_frame(module);
  bind_constraints(module);
  bind_interpolation(module);
  bind_smoothing(module);
  bind_comparison(module);
  bind_placement(module);
  bind_tubes(module);
  bind_demo_atrium(module);
  bind_atria(module);
  bind_landmark_warp(module);
}
