// SPDX-License-Identifier: MIT
#include "detail/occupancy_layers.hpp"

#include <algorithm>

namespace pectinate::detail {

OccupancyLayers::OccupancyLayers(const SurfaceMesh& mesh, const StreamlineTracer& tracer, ChordOccupancy& occupancy)
    : occupancy_(occupancy),
      blank_(mesh, tracer, occupancy.clearance()),
      shares_(mesh.triangle_count()),
      freed_(mesh.triangle_count(), 0) {}

void OccupancyLayers::add(std::int32_t line, const Polyline& polyline) {
  blank_.add(polyline);
  if (line >= std::ssize(footprints_)) footprints_.resize(line + 1);
  footprints_[line] = {};
  for (const auto t : blank_.changed()) take_over(t, line);
  for (const auto t : polyline.triangles) take_over(t, line);
}

/// Moves what is marked of a triangle from the blank to a line, unless that was done.
void OccupancyLayers::take_over(std::int32_t triangle, std::int32_t line) {
  if (!blank_.has_direction(triangle) || blank_.unseeded().is_empty(triangle)) return;
  footprints_[line].triangles.push_back(triangle);
  const auto share_out = [&](const IntervalSets& sets, bool of_seeds) {
    sets.get_intervals(triangle, intervals_);
    for (const auto& chords : intervals_) {
      shares_[triangle].push_back({line, of_seeds, chords});
      mark(triangle, shares_[triangle].back());
    }
  };
  share_out(blank_.stopped(), false);
  if (blank_.has_seed_sets()) share_out(blank_.unseeded(), true);
  blank_.reset(triangle);
}

void OccupancyLayers::mark(std::int32_t triangle, const Share& share) {
  if (share.of_seeds) {
    occupancy_.take_seeds(triangle, share.chords);
  } else {
    occupancy_.take(triangle, share.chords);
  }
}

std::vector<std::int32_t> OccupancyLayers::take_back(std::span<const std::int32_t> lines) {
  ++round_;
  std::vector<std::int32_t> freed;
  for (const auto line : lines) {
    auto& [triangles, ends, kept] = footprints_[line];
    for (const auto t : triangles) {
      std::erase_if(shares_[t], [&](const Share& share) {
        if (share.line == line) kept.push_back(share);
        return share.line == line;
      });
      ends.push_back(static_cast<std::int32_t>(kept.size()));
      if (freed_[t] != round_) freed.push_back(t);
      freed_[t] = round_;
    }
  }
  for (const auto t : freed) {
    occupancy_.reset(t);
    for (const auto& share : shares_[t]) mark(t, share);
  }
  return freed;
}

void OccupancyLayers::put_back(std::span<const std::int32_t> lines) {
  for (const auto line : lines) {
    auto& [triangles, ends, kept] = footprints_[line];
    std::int32_t next = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      for (; next < ends[i]; ++next) {
        shares_[triangles[i]].push_back(kept[next]);
        mark(triangles[i], kept[next]);
      }
    }
    ends.clear();
    kept.clear();
  }
}

std::vector<std::int32_t> OccupancyLayers::takers(std::int32_t triangle, double chord) const {
  std::vector<std::int32_t> lines;
  for (const auto& share : shares_[triangle]) {
    if (share.stops(chord)) lines.push_back(share.line);
  }
  return lines;
}

bool OccupancyLayers::is_taken_by_other(std::int32_t line, std::int32_t triangle, double chord) const {
  return std::ranges::any_of(shares_[triangle],
                             [&](const Share& share) { return share.line != line && share.stops(chord); });
}

}  // namespace pectinate::detail
