// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace pectinate::detail {

/// Items sorted into buckets 0 .. bucket_count - 1, in linear time; those of one bucket stay in the order given.
template <class Item>
class Buckets {
 public:
  template <class BucketOf>
  Buckets(const std::vector<Item>& items, std::size_t bucket_count, const BucketOf& bucket_of)
      : offsets_(bucket_count + 1, 0), items_(items.size()) {
    for (const auto& item : items) offsets_[bucket_of(item) + 1] += 1;
    std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
    auto next = offsets_;
    for (const auto& item : items) items_[next[bucket_of(item)]++] = item;
  }

  std::size_t count() const { return offsets_.size() - 1; }
  std::span<Item> bucket(std::size_t i) { return {items_.data() + offsets_[i], items_.data() + offsets_[i + 1]}; }
  /// All items, bucket after bucket.
  std::vector<Item> take() && { return std::move(items_); }

 private:
  std::vector<std::size_t> offsets_;
  std::vector<Item> items_;
};

}  // namespace pectinate::detail
