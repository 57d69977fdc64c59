// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "pectinate/mesh_rows.hpp"
#include "pectinate/types.hpp"

namespace pectinate::bindings {

namespace py = pybind11;

/// Rows of `Columns` numbers that Python handed over; keeps the array alive.
template <std::size_t Columns>
class Rows {
 public:
  /// No copy for C-contiguous float64. Throws TypeError for anything but real numbers, ValueError for another shape.
  Rows(const py::array& array, const char* name);
  std::span<const std::array<double, Columns>> span() const {
    return {reinterpret_cast<const std::array<double, Columns>*>(array_.data()),
            static_cast<std::size_t>(array_.shape(0))};
  }

 private:
  py::array_t<double, py::array::c_style> array_;
};
extern template class Rows<3>;
extern template class Rows<6>;

/// Rows of three vertex indices. Throws TypeError for anything but numbers, ValueError for another shape, InvalidMesh
/// for a number that is no 32-bit index, where a silent conversion would make another triangle of it.
std::vector<Triangle> to_triangles(const py::array& array);

/// The type that numpy sees: of enumerations, their whole numbers.
template <class T>
struct NumberOf {
  using type = T;
};
template <class T>
  requires std::is_enum_v<T>
struct NumberOf<T> {
  using type = std::underlying_type_t<T>;
};

template <class T, std::size_t Rank>
py::array read_only_view(const std::array<py::ssize_t, Rank>& shape, const T* data, py::handle owner) {
  using Number = typename NumberOf<T>::type;
  py::array_t<Number> result(shape, reinterpret_cast<const Number*>(data), owner);
  result.attr("setflags")(py::arg("write") = false);
  return result.attr("view")();  // whose flag cannot be set again, because its base is not writable
}

/// A read-only view of a vector that `owner` keeps alive.
template <class T>
py::array view(const std::vector<T>& values, py::handle owner) {
  return read_only_view(std::array{static_cast<py::ssize_t>(values.size())}, values.data(), owner);
}

template <class T, std::size_t Columns>
py::array view(const std::vector<std::array<T, Columns>>& rows, py::handle owner) {
  const std::array shape{static_cast<py::ssize_t>(rows.size()), static_cast<py::ssize_t>(Columns)};
  return read_only_view(shape, reinterpret_cast<const T*>(rows.data()), owner);
}

/// A read-only array of what is computed when it is asked for.
template <auto At>
py::array view(const ComputedRow<At>& row, py::handle) {
  using Values = std::vector<decltype(row[0])>;
  auto values = std::make_unique<Values>();
  values->reserve(row.size());
  for (const auto& value : row) values->push_back(value);
  const py::capsule owner(values.get(), [](void* memory) { delete static_cast<Values*>(memory); });
  return view(*values.release(), owner);
}

/// A getter for `def_property_readonly` that views a member of the bound object.
template <class Class, class Getter>
auto viewed(Getter getter) {
  return [getter](py::object self) { return view(std::invoke(getter, self.cast<const Class&>()), self); };
}

}  // namespace pectinate::bindings
