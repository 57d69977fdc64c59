// SPDX-License-Identifier: MIT
#include "detail/scratch.hpp"

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace pectinate::detail {

TEST_CASE("scratch: arrays of a step keep their values, whether there is room or not") {
  for (const std::size_t size : {0, 1000, 5000, 5 << 20}) {
    Scratch scratch(size);
    for (int step = 0; step < 3; ++step, scratch.next_step()) {
      std::vector<std::span<std::int32_t>> arrays;
      for (int i = 0; i < 20; ++i) {
        const auto array = scratch.array<std::int32_t>(17 * i + 1);
        std::iota(array.begin(), array.end(), 1000 * i);
        arrays.push_back(array);
        for (const auto value : scratch.array<double>(i, 0.5 * i)) CHECK(value == 0.5 * i);
      }
      for (int i = 0; i < 20; ++i) {
        CHECK(reinterpret_cast<std::uintptr_t>(arrays[i].data()) % 64 == 0);
        for (int k = 0; k < 17 * i + 1; ++k) CHECK(arrays[i][k] == 1000 * i + k);
      }
    }
  }
}

TEST_CASE("scratch: the next step has the same memory") {
  Scratch scratch(1000);
  const auto* const first = scratch.array<double>(100).data();
  CHECK(scratch.array<double>(20).data() != first);
  scratch.next_step();
  CHECK(scratch.array<double>(100).data() == first);
}

}  // namespace pectinate::detail
