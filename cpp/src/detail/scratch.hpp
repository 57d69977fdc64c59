// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory_resource>
#include <span>

#include "detail/large_array.hpp"

namespace pectinate::detail {

/// Memory for one step after the other: what was touched once costs nothing again.
class Scratch {
 public:
  explicit Scratch(std::size_t size)
      : memory_(large_array<std::byte>(fill_large_pages<std::byte>(size))), resource_(memory_.data(), memory_.size()) {}

  /// Valid until the next step.
  template <class T>
  std::span<T> array(std::size_t count, const T& value) {
    const auto result = array<T>(count);
    std::ranges::fill(result, value);
    return result;
  }
  /// The same without values.
  template <class T>
  std::span<T> array(std::size_t count) {
    return {static_cast<T*>(resource_.allocate(count * sizeof(T), 64)), count};
  }
  void next_step() { resource_.release(); }

 private:
  LargeArray<std::byte> memory_;
  std::pmr::monotonic_buffer_resource resource_;  // what does not fit it gets elsewhere
};

}  // namespace pectinate::detail
