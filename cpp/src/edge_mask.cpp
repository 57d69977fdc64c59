// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "detail/edge_point.hpp"
#include "detail/edge_search.hpp"
#include "detail/seed_regions.hpp"
#include "pectinate/occupancy.hpp"

namespace pectinate {
namespace {

constexpr int bit_count = 64;
/// Edge lengths become whole numbers for exact drawing: the mean length is this much.
constexpr double weight_of_mean_length = 4096;

std::uint64_t bit_at(double position) {
  return std::uint64_t{1} << std::clamp(static_cast<int>(position * bit_count), 0, bit_count - 1);
}

/// The bits of all sub-segments that an interval touches.
std::uint64_t bits_of(const detail::Interval& interval) {
  const std::uint64_t from_low = ~(bit_at(interval.low) - 1);
  const std::uint64_t up_to_high = bit_at(interval.high) | (bit_at(interval.high) - 1);
  return from_low & up_to_high;
}

/// The index of the n-th set bit.
int nth_set_bit(std::uint64_t bits, std::uint64_t n) {
  for (; n > 0; --n) bits &= bits - 1;
  return std::countr_zero(bits);
}

constexpr std::int32_t none = -1;

std::vector<std::int32_t> find_start_triangles(const SurfaceMesh& mesh, const StreamlineTracer& tracer) {
  std::vector<std::int32_t> triangles;
  triangles.reserve(mesh.edges().size());
  for (std::int32_t e = 0; e < static_cast<std::int32_t>(mesh.edges().size()); ++e) {
    triangles.push_back(tracer.start_triangle(e).value_or(none));
  }
  return triangles;
}

std::vector<std::uint64_t> whole_weights(const SurfaceMesh& mesh, const std::vector<std::int32_t>& start_triangles) {
  const auto& lengths = mesh.edge_lengths();
  double total = 0;
  for (const double length : lengths) total += length;
  const double scale = weight_of_mean_length * static_cast<double>(lengths.size()) / total;
  std::vector<std::uint64_t> weights;
  weights.reserve(lengths.size());
  for (std::size_t e = 0; e < lengths.size(); ++e) {
    const bool can_start = start_triangles[e] != none;
    weights.push_back(can_start ? std::max<std::uint64_t>(1, std::llround(lengths[e] * scale)) : 0);
  }
  return weights;
}

class EdgeMask final : public Occupancy {
 public:
  EdgeMask(const SurfaceMesh& mesh, const StreamlineTracer& tracer)
      : tracer_(tracer),
        search_(mesh),
        start_triangles_(find_start_triangles(mesh, tracer)),
        weights_(whole_weights(mesh, start_triangles_)),
        occupied_(weights_.size(), 0),
        retired_(weights_.size(), 0),
        free_(weights_.size()) {
    for (std::size_t e = 0; e < weights_.size(); ++e) {
      total_weight_ += bit_count * weights_[e];
      update(static_cast<std::int32_t>(e));
    }
  }

  bool admits(std::int32_t, double, const EdgePoint& exit) const override {
    return !(occupied_[exit.edge] & bit_at(exit.position));
  }

  bool admits_seed(const Seed& seed) const override {
    return weights_[seed.point.edge] > 0 && (free_bits(seed.point.edge) & bit_at(seed.point.position));
  }

  void add(const Streamline& streamline) override {
    for (std::size_t segment = 0; segment < streamline.triangles.size(); ++segment) {
      const double separation = tracer_.separation_distance(streamline.triangles[segment]);
      for (const auto& [edge, interval] : search_.near_segment(streamline, segment, separation)) {
        occupy(edge, bits_of(interval));
      }
    }
    // The line lies near itself, whatever overflow or rounding make of distances: so each line takes what was free.
    for (const auto& point : streamline.points) occupy(point.edge, bit_at(point.position));
  }

  void retire_seed(const Seed& seed) override {
    retired_[seed.point.edge] |= bit_at(seed.point.position);
    update(seed.point.edge);
  }

  std::optional<Seed> draw_seed(SeedRegion region, Random& random) const override {
    const auto drawn = free_.draw(region, random);
    if (!drawn) return std::nullopt;
    const auto edge = *drawn;
    const std::uint64_t bits = free_bits(edge);
    const int bit = nth_set_bit(bits, random.below(static_cast<std::uint64_t>(std::popcount(bits))));
    return Seed{{edge, detail::clamp_position((bit + random.unit()) / bit_count)}, start_triangles_[edge]};
  }

  double coverage() const override {
    return static_cast<double>(occupied_weight_) / static_cast<double>(total_weight_);
  }

 private:
  std::uint64_t free_bits(std::int32_t edge) const { return ~(occupied_[edge] | retired_[edge]); }

  void occupy(std::int32_t edge, std::uint64_t bits) {
    const std::uint64_t added = bits & ~occupied_[edge];
    if (!added) return;
    occupied_[edge] |= added;
    occupied_weight_ += static_cast<std::uint64_t>(std::popcount(added)) * weights_[edge];
    update(edge);
  }

  void update(std::int32_t edge) {
    const std::uint64_t free_weight = static_cast<std::uint64_t>(std::popcount(free_bits(edge))) * weights_[edge];
    free_.set(edge, free_weight, occupied_[edge] == 0);
  }

  const StreamlineTracer& tracer_;
  detail::EdgeSearch search_;
  std::vector<std::int32_t> start_triangles_;  // per edge
  std::vector<std::uint64_t> weights_;         // per sub-segment of each edge; 0 where no streamline can start
  std::vector<std::uint64_t> occupied_, retired_;
  detail::SeedRegions free_;
  std::uint64_t total_weight_ = 0, occupied_weight_ = 0;
};

}  // namespace

std::unique_ptr<Occupancy> make_edge_mask(const SurfaceMesh& mesh, const StreamlineTracer& tracer) {
  return std::make_unique<EdgeMask>(mesh, tracer);
}

}  // namespace pectinate
