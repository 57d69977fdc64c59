// SPDX-License-Identifier: MIT
#include "arrays.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "pectinate/errors.hpp"

namespace pectinate::bindings {
namespace {

std::string shape_text(const py::array& array) {
  return py::str(array.attr("shape"));
}

void check_rows(const py::array& array, std::size_t columns, const char* name, const std::string& kinds) {
  if (kinds.find(array.dtype().kind()) == std::string::npos) {
    throw py::type_error(std::string(name) + " must hold real numbers, not " +
                         std::string(py::str(array.dtype().attr("name"))));
  }
  if (array.ndim() != 2 || array.shape(1) != static_cast<py::ssize_t>(columns)) {
    throw py::value_error(std::string(name) + " has the shape " + shape_text(array) + ", but must have " +
                          std::to_string(columns) + " columns: (n, " + std::to_string(columns) + ")");
  }
}

template <class Number>
std::vector<Triangle> convert(const py::array& array) {
  const auto numbers = py::array_t<Number, py::array::c_style | py::array::forcecast>(array);
  const auto rows = numbers.template unchecked<2>();
  std::vector<Triangle> triangles(static_cast<std::size_t>(rows.shape(0)));
  for (py::ssize_t t = 0; t < rows.shape(0); ++t) {
    for (py::ssize_t k = 0; k < 3; ++k) {
      const Number number = rows(t, k);
      const bool is_index = number >= Number(0) && number <= Number(std::numeric_limits<std::int32_t>::max()) &&
                            number == static_cast<Number>(static_cast<std::int64_t>(number));
      if (!is_index) {
        throw InvalidMesh("triangle " + std::to_string(t) + " refers to vertex " +
                          std::string(py::str(py::cast(number))) +
                          ", which is no vertex index; indices are whole numbers from 0");
      }
      triangles[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)] = static_cast<std::int32_t>(number);
    }
  }
  return triangles;
}

}  // namespace

template <std::size_t Columns>
Rows<Columns>::Rows(const py::array& array, const char* name) {
  check_rows(array, Columns, name, "fiu");
  array_ = py::array_t<double, py::array::c_style | py::array::forcecast>(array);
}
template class Rows<3>;
template class Rows<6>;

std::vector<Triangle> to_triangles(const py::array& array) {
  check_rows(array, 3, "triangles", "iuf");
  switch (array.dtype().kind()) {
    case 'i':
      return convert<std::int64_t>(array);
    case 'u':
      return convert<std::uint64_t>(array);
    default:
      return convert<double>(array);
  }
}

}  // namespace pectinate::bindings
