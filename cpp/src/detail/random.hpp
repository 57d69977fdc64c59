// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <random>

namespace pectinate {

/// Random numbers that are the same on every platform, unlike the standard library's distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, bound), bound >= 1.
  std::uint64_t below(std::uint64_t bound) {
    const std::uint64_t excess = (0 - bound) % bound;  // 2^64 mod bound: the draws that would favour small numbers
    std::uint64_t draw = engine_();
    while (draw < excess) draw = engine_();
    return draw % bound;
  }

  /// Uniform in [0, 1), a multiple of 2^-53.
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace pectinate
