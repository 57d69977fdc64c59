// SPDX-License-Identifier: MIT
#include "pectinate/errors.hpp"

#include "module.hpp"

namespace pectinate::bindings {

namespace py = pybind11;

void bind_errors(py::module_& module) {
  const auto error = py::register_exception<Error>(module, "Error");
  const auto value_error = py::make_tuple(error, py::handle(PyExc_ValueError));
  const auto runtime_error = py::make_tuple(error, py::handle(PyExc_RuntimeError));
  py::register_exception<InvalidMesh>(module, "InvalidMesh", value_error);
  py::register_exception<InvalidField>(module, "InvalidField", value_error);
  py::register_exception<InvalidOption>(module, "InvalidOption", value_error);
  py::register_exception<SolverFailure>(module, "SolverFailure", runtime_error);
}

}  // namespace pectinate::bindings
