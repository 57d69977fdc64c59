// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "detail/large_array.hpp"

namespace pectinate::detail {

/// Memory for one step after the other: what was touched once costs nothing again.
class Scratch {
 public:
  explicit Scratch(std::size_t size) : memory_(large_array<std::byte>(size)) {}

  /// Valid until the next step. Without values.
  template <class T>
  std::span<T> array(std::size_t count) {
    const auto first = (used_ + alignment - 1) / alignment * alignment;
    const bool has_room = first + count * sizeof(T) <= memory_.size();
    if (has_room) used_ = first + count * sizeof(T);
    auto* const begin = has_room ? memory_.data() + first : more_.emplace_back(count * sizeof(T)).data();
    return {reinterpret_cast<T*>(begin), count};
  }
  template <class T>
  std::span<T> array(std::size_t count, const T& value) {
    const auto result = array<T>(count);
    std::ranges::fill(result, value);
    return result;
  }
  void next_step() {
    used_ = 0;
    more_.clear();
  }

 private:
  static constexpr std::size_t alignment = 64;

  LargeArray<std::byte> memory_;
  std::size_t used_ = 0;
  std::vector<LargeArray<std::byte>> more_;  // what found no place
};

}  // namespace pectinate::detail
