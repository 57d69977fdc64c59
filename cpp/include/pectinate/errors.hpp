// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>

namespace pectinate {

/// Base of everything this library throws on purpose. Messages name the element, the rule and the remedy.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The triangle soup cannot become a surface (no valid triangle, an index out of range, ...).
struct InvalidMesh : Error {
  using Error::Error;
};

/// A field that does not fit its mesh (wrong count) or gives no triangle a direction.
struct InvalidField : Error {
  using Error::Error;
};

/// An option outside its legal range.
struct InvalidOption : Error {
  using Error::Error;
};

/// A numerical solver gave no usable answer.
struct SolverFailure : Error {
  using Error::Error;
};

}  // namespace pectinate
