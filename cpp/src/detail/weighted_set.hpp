// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace pectinate::detail {

/// Whole-number weights of items 0 .. size - 1, for drawing an item by weight: a Fenwick tree.
class WeightedSet {
 public:
  explicit WeightedSet(std::size_t size) : weights_(size, 0), sums_(size + 1, 0) {}

  std::uint64_t total() const { return total_; }

  void set(std::size_t item, std::uint64_t weight) {
    const std::uint64_t change = weight - weights_[item];  // modulo 2^64: sums come out right
    if (change == 0) return;
    weights_[item] = weight;
    total_ += change;
    for (std::size_t i = item + 1; i < sums_.size(); i += i & (0 - i)) sums_[i] += change;
  }

  /// The item at `offset` in [0, total()) when the items' weights are laid out in a row.
  std::size_t find(std::uint64_t offset) const {
    std::size_t position = 0;
    for (std::size_t step = std::bit_floor(sums_.size() - 1); step > 0; step /= 2) {
      if (position + step < sums_.size() && sums_[position + step] <= offset) {
        position += step;
        offset -= sums_[position];
      }
    }
    return position;
  }

 private:
  std::vector<std::uint64_t> weights_, sums_;
  std::uint64_t total_ = 0;
};

}  // namespace pectinate::detail
