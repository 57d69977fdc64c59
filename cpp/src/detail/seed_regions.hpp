// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "detail/random.hpp"
#include "detail/weighted_set.hpp"
#include "pectinate/occupancy.hpp"

namespace pectinate::detail {

/// How much of each element (edge or triangle) is free for seeds, in whole numbers, by region.
class SeedRegions {
 public:
  explicit SeedRegions(std::size_t element_count) : partly_free_(element_count), wholly_free_(element_count) {}

  /// `untouched`: no part of the element is occupied.
  void set(std::int32_t element, std::uint64_t free_weight, bool untouched) {
    partly_free_.set(element, untouched ? 0 : free_weight);
    wholly_free_.set(element, untouched ? free_weight : 0);
  }

  /// An element drawn by its free weight, none if the region is empty.
  std::optional<std::int32_t> draw(SeedRegion region, Random& random) const {
    const std::uint64_t partly = region == SeedRegion::wholly_free ? 0 : partly_free_.total();
    const std::uint64_t wholly = region == SeedRegion::partly_free ? 0 : wholly_free_.total();
    if (partly + wholly == 0) return std::nullopt;
    const std::uint64_t offset = random.below(partly + wholly);
    return static_cast<std::int32_t>(offset < partly ? partly_free_.find(offset) : wholly_free_.find(offset - partly));
  }

 private:
  WeightedSet partly_free_, wholly_free_;
};

}  // namespace pectinate::detail
