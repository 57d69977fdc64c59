// SPDX-License-Identifier: MIT
#include "detail/chord_occupancy.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "detail/chords_near_vertices.hpp"

namespace pectinate::detail {
namespace {

/// Half of what a streamline takes at least of the chords of a triangle that it crosses.
constexpr double least_width = 1e-9;
/// Blocks of a streamline this long, in separation distances, keep the search and the list of segments short.
constexpr double block_length = 4;
/// More than single precision loses, relative to the surface's size and to a distance.
constexpr float size_slack = 4e-7F, distance_slack = 4e-6F;

/// Segments that deviate less than this, in separation distances, from a straight line are first looked at as one.
constexpr double coarse_tolerance = 0.03;
constexpr std::size_t most_joined = 8;

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

ChordOccupancy::ChordOccupancy(const SurfaceMesh& mesh, const StreamlineTracer& tracer, const Clearance& clearance,
                               const SingularRegion& singular)
    : mesh_(mesh),
      tracer_(tracer),
      sheet_(tracer.sheet()),
      clearance_(clearance),
      has_seed_sets_(clearance.seed != clearance.stop),
      has_singular_(!singular.vertices.empty() && singular.radius > 0),
      stopped_(mesh.triangle_count()),
      unseeded_(has_seed_sets_ ? mesh.triangle_count() : 0),
      singular_(has_singular_ ? mesh.triangle_count() : 0),
      origin_(vector(mesh.vertices()[0])),
      slack_(size_slack * static_cast<float>(mesh.bounding_box_diagonal())),
      tiles_(mesh.triangle_count()) {
  std::vector<bool> on_border(mesh.vertices().size(), false);
  for (const auto& loop : mesh.boundary_loops()) {
    for (const auto v : loop.vertices) on_border[v] = true;
  }
  for (std::int32_t t = 0; t < sheet_.triangle_count(); ++t) {
    auto& tile = tiles_[t];
    const Vector a = sheet_.low(t) - origin_, b = sheet_.middle(t) - origin_, c = sheet_.high(t) - origin_;
    const Vector centroid = (a + b + c) / 3;
    const double square =
        std::max({(a - centroid).squaredNorm(), (b - centroid).squaredNorm(), (c - centroid).squaredNorm()});
    tile.x = static_cast<float>(centroid.x());
    tile.y = static_cast<float>(centroid.y());
    tile.z = static_cast<float>(centroid.z());
    tile.radius = static_cast<float>(std::sqrt(square)) * (1 + distance_slack) + slack_;
    tile.neighbours = sheet_.crossings[t].neighbours;
    tile.round = 0;
    if (sheet_.has_direction(t)) continue;
    stopped_.fill(t);
    if (has_seed_sets_) unseeded_.fill(t);
  }
  for (std::int32_t t = 0; t < sheet_.triangle_count(); ++t) {
    const auto& corners = mesh.triangles()[t];
    auto& radius = tiles_[sheet_.ranks[t]].radius;
    if (on_border[corners[0]] || on_border[corners[1]] || on_border[corners[2]]) radius = -radius;
  }
  // Where the surface was cut it goes on for distances.
  for (std::int32_t edge = 0; edge < static_cast<std::int32_t>(mesh.edges().size()); ++edge) {
    const auto triangles = mesh.edge_triangles(edge);
    if (triangles.size() < 3) continue;
    for (const auto t : triangles) {
      const auto rank = sheet_.ranks[t];
      tiles_[rank].neighbours[role_with_edge(mesh, t, sheet_.crossings[rank], edge)] = none;
    }
  }
  if (has_singular_) keep_out_of(singular);
}

void ChordOccupancy::keep_out_of(const SingularRegion& region) {
  for (const auto& [triangle, chords] : chords_near_vertices(mesh_, sheet_, region.vertices, region.radius)) {
    stopped_.add(triangle, chords);
    if (has_seed_sets_) unseeded_.add(triangle, chords);
    singular_.add(triangle, chords);
  }
}

void ChordOccupancy::add(const Polyline& line) {
  changed_.clear();
  for (std::size_t first = 0, last = 0; first < line.triangles.size(); first = last) {
    const double longest = block_length * separation(line.triangles[first]);
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
  for (auto i = first; i < last; ++i) reach(line.triangles[i], std::abs(tiles_[line.triangles[i]].radius));
  for (std::size_t i = 0; i < queue_.size(); ++i) visit(queue_[i], line, first);
}

void ChordOccupancy::Segments::add(const Vector& start, const Vector& axis) {
  const auto set = [&](float* coordinates, double value) { coordinates[count] = static_cast<float>(value); };
  set(x, start.x()), set(y, start.y()), set(z, start.z());
  set(dx, axis.x()), set(dy, axis.y()), set(dz, axis.z());
  const double length_square = axis.squaredNorm();
  set(inverse_square, length_square > 1e-30 ? 1 / length_square : 0);
  ++count;
}

void ChordOccupancy::Segments::fill_up() {
  for (int i = count; i % lanes != 0; ++i) {
    x[i] = y[i] = z[i] = 1e15F;
    dx[i] = dy[i] = dz[i] = inverse_square[i] = 0;
  }
}

float ChordOccupancy::Segments::distance(float x0, float y0, float z0) {
  Lanes nearest = Lanes::Constant(1e30F);
  for (int i = 0; i < count; i += lanes) {
    Lanes px = x0 - lanes_at(x + i), py = y0 - lanes_at(y + i), pz = z0 - lanes_at(z + i);
    const auto ax = lanes_at(dx + i), ay = lanes_at(dy + i), az = lanes_at(dz + i);
    const Lanes along = ((px * ax + py * ay + pz * az) * lanes_at(inverse_square + i)).max(0.F).min(1.F);
    px -= along * ax;
    py -= along * ay;
    pz -= along * az;
    const Lanes result = px * px + py * py + pz * pz;
    lanes_at(square + i) = result;
    nearest = nearest.min(result);
  }
  return std::sqrt(nearest.minCoeff());
}

void ChordOccupancy::fill_block(const Polyline& line, std::size_t first, std::size_t last) {
  auto& segments = block_.segments;
  segments.clear();
  const double reach = greatest_clearance() * (1 + guard) * (1 + distance_slack);
  for (auto i = first; i < last; ++i) {
    block_.separation[i - first] = separation(line.triangles[i]);
    block_.reach[i - first] = static_cast<float>(reach * block_.separation[i - first]);
    segments.add(line.points[i] - origin_, line.points[i + 1] - line.points[i]);
  }
  const auto [least, greatest] = std::minmax_element(block_.reach, block_.reach + segments.count);
  block_.least_reach = *least;
  block_.greatest_reach = *greatest;
  for (int i = segments.count; i % lanes != 0; ++i) block_.reach[i] = 0;
  segments.fill_up();
  simplify_block(line, first);
}

/// Joins consecutive segments of the block at hand that are nearly in line.
void ChordOccupancy::simplify_block(const Polyline& line, std::size_t first) {
  auto& coarse = block_.coarse;
  coarse.clear();
  block_.coarse_error = std::numeric_limits<float>::infinity();
  if (block_.least_reach != block_.greatest_reach) return;
  // All points between within this of the straight line: then no point of either is farther from the other.
  const auto deviation = [&](std::size_t from, std::size_t to) {
    double greatest = 0;
    for (auto i = from + 1; i < to; ++i) {
      greatest = std::max(greatest, distance_to_segment(line.points[i], line.points[from], line.points[to]));
    }
    return greatest;
  };
  const double tolerance = coarse_tolerance * block_.separation[0];
  double error = 0;
  const auto last = first + static_cast<std::size_t>(block_.segments.count);
  for (auto from = first; from < last;) {
    auto to = from + 1;
    for (; to < last && to - from < most_joined; ++to) {
      const double next = deviation(from, to + 1);
      if (next > tolerance) break;
      error = std::max(error, next);
    }
    coarse.add(line.points[from] - origin_, line.points[to] - line.points[from]);
    from = to;
  }
  block_.coarse_error = static_cast<float>(error) * (1 + distance_slack) + slack_;
  coarse.fill_up();
}

void ChordOccupancy::measure_distances(const Tile& tile) {
  block_.nearest = block_.segments.distance(tile.x, tile.y, tile.z);
}

void ChordOccupancy::reach(std::int32_t triangle, float distance) {
  auto& tile = tiles_[triangle];
  if (tile.round == round_) return;
  tile.round = round_;
  queue_.push_back({triangle, distance});
  // By the time its turn comes these will be at hand.
  __builtin_prefetch(&sheet_.corners[triangle]);
  __builtin_prefetch(&sheet_.crossings[triangle]);
  for (const auto next : tile.neighbours) {
    if (next != none) __builtin_prefetch(&tiles_[next]);
  }
}

void ChordOccupancy::reach_from(const Reached& from, std::int32_t triangle) {
  const auto &tile = tiles_[triangle], &there = tiles_[from.triangle];
  if (tile.round == round_) return;
  const float x = tile.x - there.x, y = tile.y - there.y, z = tile.z - there.z;
  reach(triangle, (from.distance + std::sqrt(x * x + y * y + z * z)) * (1 + distance_slack) + slack_);
}

void ChordOccupancy::reach_neighbours(const Reached& from) {
  for (const auto role : {low_high, low_middle, middle_high}) {
    const auto next = tiles_[from.triangle].neighbours[role];
    if (next != none) {
      reach_from(from, next);
    } else {  // where the surface was cut at a non-manifold edge, it goes on for distances
      const auto edge = edge_of(mesh_, sheet_.mesh_triangles[from.triangle], sheet_.crossings[from.triangle], role);
      for (const auto other : mesh_.edge_triangles(edge)) reach_from(from, sheet_.ranks[other]);
    }
  }
}

void ChordOccupancy::visit(Reached reached, const Polyline& line, std::size_t first) {
  const auto triangle = reached.triangle;
  const auto& tile = tiles_[triangle];
  const float radius = std::abs(tile.radius);
  // A jagged border can part triangles that lie side by side: there the search goes on one edge farther.
  const float limit = tile.radius < 0 ? 3 * radius : radius;
  const Marking stops{clearance_.stop, static_cast<float>(clearance_.stop / greatest_clearance()), stopped_};
  const Marking seeds{clearance_.seed, static_cast<float>(clearance_.seed / greatest_clearance()), unseeded_};
  bool is_measured = false;
  const auto measure = [&] {
    if (!is_measured) measure_distances(tile);
    is_measured = true;
  };
  // Most of the band is known to be well inside from the way that led here.
  if (!lies_in_capsule(reached, stops)) {
    const float coarse = block_.coarse.distance(tile.x, tile.y, tile.z), error = block_.coarse_error;
    if (coarse - error > limit + block_.greatest_reach) return;
    if (coarse + error > limit + block_.least_reach) {
      measure();
      if (nearest_capsule(1) > limit) return;
    }
    reached.distance = std::min(reached.distance, coarse + error);
  }
  reach_neighbours(reached);
  const auto mark_in = [&](const Marking& marking) {
    if (marking.sets.is_full(triangle)) return;
    if (lies_in_capsule(reached, marking)) {
      fill(triangle, marking.sets);
    } else {
      measure();
      mark(triangle, line, first, marking);
    }
  };
  mark_in(stops);
  if (has_seed_sets_) mark_in(seeds);
}

/// Does a disc around the triangle lie in a capsule, whose axis is no farther than we know?
bool ChordOccupancy::lies_in_capsule(const Reached& reached, const Marking& marking) const {
  return reached.distance + std::abs(tiles_[reached.triangle].radius) <=
         (marking.share - 3 * distance_slack) * block_.least_reach;
}

void ChordOccupancy::fill(std::int32_t triangle, IntervalSets& sets) {
  sets.fill(triangle);
  if (&sets == &unseeded()) changed_.push_back(triangle);
}

float ChordOccupancy::nearest_capsule(float share) const {
  if (block_.least_reach == block_.greatest_reach) return block_.nearest - share * block_.greatest_reach;
  Lanes nearest = Lanes::Constant(1e30F);
  for (int i = 0; i < block_.segments.count; i += lanes) {
    nearest = nearest.min(lanes_at(block_.segments.square + i).sqrt() - share * lanes_at(block_.reach + i));
  }
  return nearest.minCoeff();
}

/// Marks the chords within a clearance of the block's segments.
void ChordOccupancy::mark(std::int32_t triangle, const Polyline& line, std::size_t first, const Marking& marking) {
  auto& sets = marking.sets;
  const float radius = std::abs(tiles_[triangle].radius);
  const float nearest = nearest_capsule(marking.share);
  if (nearest > radius) return;
  if (nearest + radius <= -3 * distance_slack * block_.greatest_reach) {
    sets.fill(triangle);  // a disc around it lies in one capsule
  } else {
    mark_exactly(triangle, line, first, marking);
  }
  changed_.push_back(triangle);
}

/// Adds the chords that one capsule takes.
void ChordOccupancy::mark_chords(std::int32_t triangle, const ChordFrame& frame, const GuardedCapsule& guarded,
                                 IntervalSets& sets) {
  const auto& [capsule, margin] = guarded;
  const auto reach = frame.reach(capsule);
  if (!reach) return;
  const Interval within{std::max(0.0, reach->low), std::min(1.0, reach->high)};
  if (within.low > within.high || sets.contains(triangle, within)) return;
  const auto view = frame.look(capsule);
  if (&sets == &unseeded_) {
    for (const auto& chords : frame.core(capsule, view)) {
      if (chords) sets.add(triangle, *chords);
    }
  } else if (const auto chords = frame.shadow(capsule, view)) {
    const Interval taken{chords->low - margin, chords->high + margin};
    sets.add(triangle, taken);
    if (has_seed_sets_) unseeded_.add(triangle, taken);
  }
}

void ChordOccupancy::mark_exactly(std::int32_t triangle, const Polyline& line, std::size_t first,
                                  const Marking& marking) {
  auto& sets = marking.sets;
  const ChordFrame frame(sheet_.low(triangle), sheet_.middle(triangle), sheet_.high(triangle),
                         sheet_.crossings[triangle].split);
  const float radius = std::abs(tiles_[triangle].radius);
  // Consecutive capsules share a point.
  int last_end = -1;
  Vector last_point;
  /// Adds a capsule's chords, but not those that the one before or behind it takes anyway; is it the one behind?
  const auto add = [&](int i, bool is_left_to_next) {
    const double* separations = block_.separation + i;
    const Vector start = last_end == i ? last_point : frame.flat(line.points[first + i]);
    last_point = frame.flat(line.points[first + i + 1]);
    last_end = i + 1;
    const Capsule capsule{start, last_point, marking.clearance * *separations * (1 + guard)};
    const auto [is_before_start, is_beyond_end] = frame.range_along(capsule);
    if (is_beyond_end && i + 1 < block_.segments.count && separations[1] >= separations[0]) return true;
    if (is_before_start && i > 0 && !is_left_to_next && separations[-1] >= separations[0]) return false;
    mark_chords(triangle, frame, {capsule, guard * *separations / frame.width()}, sets);
    return false;
  };
  bool is_left_to_next = false;
  const float greatest_limit = radius + marking.share * block_.greatest_reach;
  for (int group = 0; group < block_.segments.count; group += lanes) {
    if (lanes_at(block_.segments.square + group).minCoeff() > greatest_limit * greatest_limit) continue;
    for (int i = group; i < std::min(group + lanes, block_.segments.count) && !sets.is_full(triangle); ++i) {
      const float limit = radius + marking.share * block_.reach[i];
      if (block_.segments.square[i] <= limit * limit) is_left_to_next = add(i, is_left_to_next);
    }
  }
}

double ChordOccupancy::free_share(std::int32_t triangle) const {
  const auto& crossings = sheet_.crossings[triangle];
  if (unseeded().is_full(triangle)) return 0;
  double share = 0;
  for (const auto& gap : unseeded().gaps(triangle)) {
    share += area_share(crossings, gap.high) - area_share(crossings, gap.low);
  }
  return share;
}

double ChordOccupancy::coverage() const {
  double free = 0, all = 0;
  for (std::int32_t t = 0; t < sheet_.triangle_count(); ++t) {
    if (!sheet_.has_direction(t)) continue;
    const double area = mesh_.triangle_areas()[sheet_.mesh_triangles[t]];
    all += area;
    if (stopped_.is_full(t)) continue;
    for (const auto& gap : stopped_.gaps(t)) {
      free += area * (area_share(sheet_.crossings[t], gap.high) - area_share(sheet_.crossings[t], gap.low));
    }
  }
  return 1 - free / all;
}

}  // namespace pectinate::detail
