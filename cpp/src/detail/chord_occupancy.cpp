// SPDX-License-Identifier: MIT
#include "detail/chord_occupancy.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "detail/chord_shadow.hpp"

namespace pectinate::detail {
namespace {

/// Half of what a streamline takes at least of the chords of a triangle that it crosses.
constexpr double least_width = 1e-9;
/// Blocks of a streamline this long, in separation distances, keep the search and the list of segments short.
constexpr double block_length = 4;
/// More than single precision loses, relative to the surface's size and to a distance.
constexpr float size_slack = 4e-7F, distance_slack = 4e-6F;

/// In place of a neighbour: a border, or more than two triangles at the edge.
constexpr std::int32_t none = -1;

using Lanes = Eigen::Array<float, 8, 1>;

auto lanes_at(float* values) {
  return Eigen::Map<Lanes, Eigen::Aligned32>(values);
}
auto lanes_at(const float* values) {
  return Eigen::Map<const Lanes, Eigen::Aligned32>(values);
}

}  // namespace

ChordOccupancy::ChordOccupancy(const SurfaceMesh& mesh, const StreamlineTracer& tracer, const Clearance& clearance)
    : mesh_(mesh),
      tracer_(tracer),
      clearance_(clearance),
      has_seed_sets_(clearance.seed != clearance.stop),
      stopped_(mesh.triangle_count()),
      unseeded_(has_seed_sets_ ? mesh.triangle_count() : 0),
      origin_(vector(mesh.vertices()[0])),
      tiles_(mesh.triangle_count()) {
  std::vector<bool> on_border(mesh.vertices().size(), false);
  for (const auto& loop : mesh.boundary_loops()) {
    for (const auto v : loop.vertices) on_border[v] = true;
  }
  const auto slack = size_slack * static_cast<float>(mesh.bounding_box_diagonal());
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(tiles_.size()); ++t) {
    const auto& corners = mesh.triangles()[t];
    const auto corner = [&](int k) -> Vector { return vector(mesh.vertices()[corners[k]]) - origin_; };
    const Vector centroid = (corner(0) + corner(1) + corner(2)) / 3;
    double square = 0;
    auto& tile = tiles_[t];
    bool border = false;
    for (int k = 0; k < 3; ++k) {
      square = std::max(square, (corner(k) - centroid).squaredNorm());
      const bool joins_two = mesh.edge_triangles(mesh.triangle_edges()[t][k]).size() == 2;
      tile.neighbours[k] = joins_two ? mesh.neighbour(t, k).triangle : none;
      border |= on_border[corners[k]];
    }
    tile.x = static_cast<float>(centroid.x());
    tile.y = static_cast<float>(centroid.y());
    tile.z = static_cast<float>(centroid.z());
    tile.radius = static_cast<float>(std::sqrt(square)) * (1 + distance_slack) + slack;
    if (border) tile.radius = -tile.radius;
    tile.round = 0;
    if (tracer.has_direction(t)) continue;
    stopped_.fill(t);
    if (has_seed_sets_) unseeded_.fill(t);
  }
}

void ChordOccupancy::add(const Polyline& line) {
  changed_.clear();
  for (std::size_t first = 0, last = 0; first < line.triangles.size(); first = last) {
    const double longest = block_length * tracer_.separation_distance(line.triangles[first]);
    double length = 0;
    while (last < line.triangles.size() && length < longest && last - first < most_segments) {
      length += (line.points[last + 1] - line.points[last]).norm();
      ++last;
    }
    add_block(line, first, last);
  }
  // The line lies near itself, whatever overflow or rounding make of distances: so each line takes what was free.
  for (std::size_t i = 0; i < line.triangles.size(); ++i) {
    const Interval own{line.chords[i] - least_width, line.chords[i] + least_width};
    stopped_.add(line.triangles[i], own);
    if (has_seed_sets_) unseeded_.add(line.triangles[i], own);
  }
}

void ChordOccupancy::retire_seed(std::int32_t triangle, const Interval& chords) {
  if (!has_seed_sets_) {
    unseeded_ = stopped_;
    has_seed_sets_ = true;
  }
  unseeded_.add(triangle, chords);
}

/// Breadth-first over the surface from the block's own triangles, through whatever is near.
void ChordOccupancy::add_block(const Polyline& line, std::size_t first, std::size_t last) {
  fill_block(line, first, last);
  ++round_;
  queue_.clear();
  for (auto i = first; i < last; ++i) reach(line.triangles[i]);
  for (std::size_t i = 0; i < queue_.size(); ++i) visit(queue_[i], line, first);
}

void ChordOccupancy::fill_block(const Polyline& line, std::size_t first, std::size_t last) {
  block_.count = static_cast<int>(last - first);
  const double reach = std::max(clearance_.stop, clearance_.seed) * (1 + guard) * (1 + distance_slack);
  for (int i = 0; i < block_.count; ++i) {
    const Vector start = line.points[first + i] - origin_, axis = line.points[first + i + 1] - line.points[first + i];
    const auto set = [&](float* coordinates, double value) { coordinates[i] = static_cast<float>(value); };
    set(block_.x, start.x()), set(block_.y, start.y()), set(block_.z, start.z());
    set(block_.dx, axis.x()), set(block_.dy, axis.y()), set(block_.dz, axis.z());
    const double square = axis.squaredNorm();
    set(block_.inverse_square, square > 1e-30 ? 1 / square : 0);
    set(block_.reach, reach * tracer_.separation_distance(line.triangles[first + i]));
  }
  block_.greatest_reach = *std::max_element(block_.reach, block_.reach + block_.count);
  // Whole groups of lanes: what is too many is far away.
  for (int i = block_.count; i % lanes != 0; ++i) {
    block_.x[i] = block_.y[i] = block_.z[i] = 1e15F;
    block_.dx[i] = block_.dy[i] = block_.dz[i] = block_.inverse_square[i] = block_.reach[i] = 0;
  }
}

void ChordOccupancy::measure_distances(const Tile& tile) {
  for (int i = 0; i < block_.count; i += lanes) {
    Lanes x = tile.x - lanes_at(block_.x + i), y = tile.y - lanes_at(block_.y + i), z = tile.z - lanes_at(block_.z + i);
    const auto dx = lanes_at(block_.dx + i), dy = lanes_at(block_.dy + i), dz = lanes_at(block_.dz + i);
    const Lanes along = ((x * dx + y * dy + z * dz) * lanes_at(block_.inverse_square + i)).max(0.F).min(1.F);
    x -= along * dx;
    y -= along * dy;
    z -= along * dz;
    lanes_at(block_.distance + i) = (x * x + y * y + z * z).sqrt();
  }
}

void ChordOccupancy::reach(std::int32_t triangle) {
  auto& tile = tiles_[triangle];
  if (tile.round == round_) return;
  tile.round = round_;
  queue_.push_back(triangle);
  for (const auto next : tile.neighbours) {
    if (next != none) __builtin_prefetch(&tiles_[next]);
  }
}

void ChordOccupancy::reach_neighbours(std::int32_t triangle) {
  for (int side = 0; side < 3; ++side) {
    const auto next = tiles_[triangle].neighbours[side];
    if (next != none) {
      reach(next);
    } else {  // where the surface was cut at a non-manifold edge, it goes on for distances
      for (const auto t : mesh_.edge_triangles(mesh_.triangle_edges()[triangle][side])) reach(t);
    }
  }
}

void ChordOccupancy::visit(std::int32_t triangle, const Polyline& line, std::size_t first) {
  const auto& tile = tiles_[triangle];
  const float radius = std::abs(tile.radius);
  measure_distances(tile);
  // A jagged border can part triangles that lie side by side: there the search goes on one edge farther.
  if (nearest_capsule(1) > (tile.radius < 0 ? 3 * radius : radius)) return;
  reach_neighbours(triangle);
  mark(triangle, line, first, clearance_.stop, stopped_);
  if (has_seed_sets_) mark(triangle, line, first, clearance_.seed, unseeded_);
}

float ChordOccupancy::nearest_capsule(float share) const {
  Lanes nearest = Lanes::Constant(1e30F);
  for (int i = 0; i < block_.count; i += lanes) {
    nearest = nearest.min(lanes_at(block_.distance + i) - share * lanes_at(block_.reach + i));
  }
  return nearest.minCoeff();
}

/// Marks the chords within a clearance of the block's segments.
void ChordOccupancy::mark(std::int32_t triangle, const Polyline& line, std::size_t first, double clearance,
                          IntervalSets& sets) {
  if (sets.is_full(triangle)) return;
  const float radius = std::abs(tiles_[triangle].radius);
  const auto share = static_cast<float>(clearance / std::max(clearance_.stop, clearance_.seed));
  const float nearest = nearest_capsule(share);
  if (nearest > radius) return;
  if (nearest + radius <= -3 * distance_slack * block_.greatest_reach) {
    sets.fill(triangle);  // a disc around it lies in one capsule
  } else {
    mark_exactly(triangle, line, first, {share, clearance, sets});
  }
  if (&sets == &unseeded()) changed_.push_back(triangle);
}

void ChordOccupancy::mark_exactly(std::int32_t triangle, const Polyline& line, std::size_t first,
                                  const Marking& marking) {
  auto& sets = marking.sets;
  const ChordFrame frame(mesh_, triangle, tracer_.crossings()[triangle]);
  const float radius = std::abs(tiles_[triangle].radius);
  const auto gap = [&](int i) { return block_.distance[i] - marking.share * block_.reach[i]; };
  const auto add = [&](int i) {
    if (gap(i) > radius) return;
    const double separation = tracer_.separation_distance(line.triangles[first + i]);
    const Capsule capsule{line.points[first + i], line.points[first + i + 1],
                          marking.clearance * separation * (1 + guard)};
    const auto reach = frame.reach(capsule);
    if (!reach) return;
    const Interval within{std::max(0.0, reach->chords.low), std::min(1.0, reach->chords.high)};
    if (within.low > within.high || sets.contains(triangle, within)) return;
    const double margin = guard * separation / frame.width();
    if (const auto chords = frame.shadow(capsule, *reach)) {
      sets.add(triangle, {chords->low - margin, chords->high + margin});
    }
  };
  // The nearest first: it often spares the others.
  int nearest = 0;
  for (int i = 1; i < block_.count; ++i) {
    if (gap(i) < gap(nearest)) nearest = i;
  }
  add(nearest);
  for (int i = 0; i < block_.count && !sets.is_full(triangle); ++i) {
    if (i != nearest) add(i);
  }
}

double ChordOccupancy::free_share(std::int32_t triangle) const {
  const auto& crossings = tracer_.crossings()[triangle];
  if (unseeded().is_full(triangle)) return 0;
  double share = 0;
  for (const auto& gap : unseeded().gaps(triangle)) {
    share += area_share(crossings, gap.high) - area_share(crossings, gap.low);
  }
  return share;
}

double ChordOccupancy::coverage() const {
  double free = 0, all = 0;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(tiles_.size()); ++t) {
    if (!tracer_.has_direction(t)) continue;
    const double area = mesh_.triangle_areas()[t];
    all += area;
    if (stopped_.is_full(t)) continue;
    for (const auto& gap : stopped_.gaps(t)) {
      free += area * (area_share(tracer_.crossings()[t], gap.high) - area_share(tracer_.crossings()[t], gap.low));
    }
  }
  return 1 - free / all;
}

}  // namespace pectinate::detail
