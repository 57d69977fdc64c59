// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace pectinate::detail {

/// A number for a message: six digits at most, and an exponent where it is huge or tiny.
inline std::string number_text(double number) {
  constexpr int digits = 6;
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::general, digits);
  return {text.data(), end.ptr};
}

}  // namespace pectinate::detail
