// SPDX-License-Identifier: MIT
#include "detail/self_approach.hpp"

#include <algorithm>
#include <cmath>

namespace pectinate::detail {
namespace {

constexpr std::int32_t none = -1;
constexpr std::size_t first_slot_count = 64;

}  // namespace

void SelfApproach::start(double distance, const Vector& origin) {
  // Long streamlines are rare: emptying only what this one used keeps the others cheap.
  if (slots_.empty()) slots_.assign(first_slot_count, none);
  for (const auto& entry : entries_) slots_[slot_of(cell_of(entry.point))] = none;
  entries_.clear();
  distance_ = distance;
  origin_ = origin;
  least_arc_ = greatest_arc_ = 0;
}

bool SelfApproach::is_near(const Vector& point, double arc) const {
  const double apart = 2 * distance_;
  if (arc - least_arc_ <= apart && greatest_arc_ - arc <= apart) return false;
  const auto center = cell_of(point);
  for (std::int64_t i = 0; i < 27; ++i) {
    const Cell cell{center[0] + i % 3 - 1, center[1] + i / 3 % 3 - 1, center[2] + i / 9 - 1};
    for (auto e = slots_[slot_of(cell)]; e != none; e = entries_[e].next) {
      const auto& entry = entries_[e];
      if (std::abs(entry.arc - arc) > apart && (entry.point - point).squaredNorm() < distance_ * distance_) return true;
    }
  }
  return false;
}

void SelfApproach::add(const Vector& point, double arc) {
  if (2 * entries_.size() >= slots_.size()) grow();
  least_arc_ = std::min(least_arc_, arc);
  greatest_arc_ = std::max(greatest_arc_, arc);
  auto& first = slots_[slot_of(cell_of(point))];
  entries_.push_back({point, arc, first});
  first = static_cast<std::int32_t>(entries_.size()) - 1;
}

SelfApproach::Cell SelfApproach::cell_of(const Vector& point) const {
  const auto index = [&](double x) { return static_cast<std::int64_t>(std::floor(x / distance_)); };
  const Vector local = point - origin_;
  return {index(local.x()), index(local.y()), index(local.z())};
}

std::size_t SelfApproach::slot_of(const Cell& cell) const {
  const auto mix = [](std::int64_t c, std::uint64_t prime) { return static_cast<std::uint64_t>(c) * prime; };
  const auto hash =
      mix(cell[0], 0x9e3779b97f4a7c15) ^ mix(cell[1], 0xc2b2ae3d27d4eb4f) ^ mix(cell[2], 0x165667b19e3779f9);
  return (hash ^ hash >> 29) & (slots_.size() - 1);
}

void SelfApproach::grow() {
  slots_.assign(2 * slots_.size(), none);
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    auto& first = slots_[slot_of(cell_of(entries_[e].point))];
    entries_[e].next = first;
    first = static_cast<std::int32_t>(e);
  }
}

}  // namespace pectinate::detail
