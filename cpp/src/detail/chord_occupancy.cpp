// SPDX-License-Identifier: MIT
#include "detail/chord_occupancy.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

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
/// Of the triangles that the search will visit, the records are fetched so many before.
constexpr std::size_t visited_ahead = 4;

constexpr float infinity = std::numeric_limits<float>::infinity();

/// In place of a distance that is not measured yet.
constexpr float unknown = -1;

/// In place of a neighbour: a border, or more than two triangles at the edge.
constexpr std::int32_t none = -1;

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
      tiles_(large_array<Tile>(mesh.triangle_count())),
      stop_marks_(sheet_, CapsuleMarks::Kind::shadows,
                  [this](auto triangle, const auto& chords) { take(triangle, chords); }),
      seed_marks_(sheet_, CapsuleMarks::Kind::cores,
                  [this](auto triangle, const auto& chords) { take_seeds(triangle, chords); }) {
  make_tiles();
  // Where the surface was cut it goes on for distances.
  const bool is_cut = !mesh.repairs().non_manifold_edges.empty();
  for (std::int32_t edge = 0; is_cut && edge < static_cast<std::int32_t>(mesh.edges().size()); ++edge) {
    const auto triangles = mesh.edge_triangles(edge);
    if (triangles.size() < 3) continue;
    for (const auto t : triangles) {
      const auto rank = sheet_.ranks[t];
      tiles_[rank].neighbours[role_with_edge(mesh, t, sheet_.crossings[rank], edge)] = none;
    }
  }
  if (has_singular_) keep_out_of(singular);
}

void ChordOccupancy::make_tiles() {
  using Point = Eigen::Array4f;
  auto points = large_array<Point>(sheet_.vertices.size());
  for (std::size_t v = 0; v < points.size(); ++v) {
    points[v] << (sheet_.vertices[v] - origin_).cast<float>().array(), 0.F;
  }
  LargeArray<std::uint8_t> is_on_border(points.size(), 0);
  for (std::int32_t t = 0; t < sheet_.triangle_count(); ++t) {
    const auto& [low, middle, high, mesh_triangle] = sheet_.triangles[t];
    const Point &a = points[low], &b = points[middle], &c = points[high];
    const Point centroid = (a + b + c) * (1.F / 3);
    const float square =
        std::max({(a - centroid).square().sum(), (b - centroid).square().sum(), (c - centroid).square().sum()});
    const auto& neighbours = sheet_.crossings[t].neighbours;
    // Where single precision overflows, everything may be near.
    const float radius = std::isfinite(square) ? std::sqrt(square) * (1 + distance_slack) + slack_ : infinity;
    tiles_[t] = {centroid[0], centroid[1], centroid[2], radius, neighbours, 0};
    for (const auto role : {low_high, low_middle, middle_high}) {
      if (neighbours[role] >= 0 || !lies_on_border(t, role)) continue;
      is_on_border[role == middle_high ? middle : low] = is_on_border[role == low_middle ? middle : high] = 1;
    }
    if (sheet_.has_direction(t)) continue;
    stopped_.fill(t);
    if (has_seed_sets_) unseeded_.fill(t);
  }
  for (std::int32_t t = 0; t < sheet_.triangle_count(); ++t) {
    const auto& [low, middle, high, mesh_triangle] = sheet_.triangles[t];
    if (is_on_border[low] | is_on_border[middle] | is_on_border[high]) tiles_[t].radius *= -1;
  }
}

/// Or is it one where the surface was cut?
bool ChordOccupancy::lies_on_border(std::int32_t triangle, Role side) const {
  const auto edge = edge_of(mesh_, sheet_.mesh_triangle(triangle), sheet_.crossings[triangle], side);
  return mesh_.edge_triangles(edge).size() == 1;
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
    while (last < line.triangles.size() && length < longest && last - first < Segments::most) {
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

void ChordOccupancy::reset(std::int32_t triangle) {
  if (!sheet_.has_direction(triangle)) return;
  stopped_.clear(triangle);
  if (has_seed_sets_) unseeded_.clear(triangle);
  if (!has_singular_) return;
  for (const auto& chords : singular_.intervals(triangle)) take(triangle, chords);
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
  // Most of the band is known to be well inside from the way that led there; what stops streamlines takes seeds, too.
  const float depth = depth_inside(stops());
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    if (i + visited_ahead < queue_.size()) prefetch(queue_[i + visited_ahead].triangle);
    const auto reached = queue_[i];
    if (reached.distance + std::abs(tiles_[reached.triangle].radius) <= depth) {
      reach_neighbours(reached);
      fill(reached.triangle, stopped_);
      if (has_seed_sets_) fill(reached.triangle, unseeded_);
    } else {
      visit_border(reached, line, first);
    }
  }
  stop_marks_.finish();
  seed_marks_.finish();
}

void ChordOccupancy::fill_block(const Polyline& line, std::size_t first, std::size_t last) {
  auto& segments = block_.segments;
  segments.count = 0;
  const double reach = greatest_clearance() * (1 + guard) * (1 + distance_slack);
  block_.least_reach = infinity;
  block_.greatest_reach = 0;
  for (auto i = first; i < last; ++i) {
    block_.separation[i - first] = separation(line.triangles[i]);
    const auto segment_reach = static_cast<float>(reach * block_.separation[i - first]);
    block_.least_reach = std::min(block_.least_reach, segment_reach);
    block_.greatest_reach = std::max(block_.greatest_reach, segment_reach);
    segments.add(line.points[i] - origin_, line.points[i + 1] - line.points[i], segment_reach);
  }
  segments.fill_up();
  note_who_takes_ends();
  simplify_block(line, first);
}

/// Where capsules meet, their balls are the same, or one holds the other.
void ChordOccupancy::note_who_takes_ends() {
  const int count = block_.segments.count;
  block_.next_takes.fill(0);
  block_.previous_takes.fill(0);
  for (int i = 0; i + 1 < count; ++i) {
    const int next = i + 1;
    const auto bit = [](int segment) { return static_cast<std::uint8_t>(1U << segment % Segments::group_size); };
    if (block_.separation[next] >= block_.separation[i]) block_.next_takes[i / Segments::group_size] |= bit(i);
    if (block_.separation[i] >= block_.separation[next]) {
      block_.previous_takes[next / Segments::group_size] |= bit(next);
    }
  }
}

/// Joins consecutive segments of the block at hand that are nearly in line.
void ChordOccupancy::simplify_block(const Polyline& line, std::size_t first) {
  auto& coarse = block_.coarse;
  coarse.count = 0;
  block_.coarse_error = infinity;
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
    coarse.add(line.points[from] - origin_, line.points[to] - line.points[from], block_.least_reach);
    from = to;
  }
  block_.coarse_error = static_cast<float>(error) * (1 + distance_slack) + slack_;
  coarse.fill_up();
}

void ChordOccupancy::measure_distances(const Tile& tile) {
  block_.nearest = distance(block_.segments, {tile.x, tile.y, tile.z});
}

inline void ChordOccupancy::reach(std::int32_t triangle, float distance) {
  auto& tile = tiles_[triangle];
  if (tile.round == round_) return;
  tile.round = round_;
  queue_.push_back({triangle, distance});
  // By the time its turn comes these will be at hand.
  for (const auto next : tile.neighbours) __builtin_prefetch(tiles_.data() + next);
}

inline void ChordOccupancy::reach_from(const Tile& from, float distance, std::int32_t triangle) {
  const auto& tile = tiles_[triangle];
  if (tile.round == round_) return;
  const float x = tile.x - from.x, y = tile.y - from.y, z = tile.z - from.z;
  reach(triangle, (distance + std::sqrt(x * x + y * y + z * z)) * (1 + distance_slack) + slack_);
}

inline void ChordOccupancy::reach_neighbours(const Reached& from) {
  const auto& tile = tiles_[from.triangle];
  for (const auto role : {low_high, low_middle, middle_high}) {
    const auto next = tile.neighbours[role];
    if (next != none) {
      reach_from(tile, from.distance, next);
    } else {  // where the surface was cut at a non-manifold edge, it goes on for distances
      const auto edge = edge_of(mesh_, sheet_.mesh_triangle(from.triangle), sheet_.crossings[from.triangle], role);
      for (const auto other : mesh_.edge_triangles(edge)) reach_from(tile, from.distance, sheet_.ranks[other]);
    }
  }
}

/// Visits a triangle that may not lie wholly within the band.
void ChordOccupancy::visit_border(Reached reached, const Polyline& line, std::size_t first) {
  const auto& tile = tiles_[reached.triangle];
  const float radius = std::abs(tile.radius);
  // A jagged border can part triangles that lie side by side: there the search goes on one edge farther.
  const float limit = tile.radius < 0 ? 3 * radius : radius;
  // What is taken already is only passed through; known to be near, it needs no distance.
  if (reached.distance <= limit + block_.least_reach && is_full(reached.triangle)) {
    reach_neighbours(reached);
    return;
  }
  block_.nearest = unknown;
  const float coarse = distance(block_.coarse, {tile.x, tile.y, tile.z}), error = block_.coarse_error;
  if (coarse - error > limit + block_.greatest_reach) return;
  if (coarse + error > limit + block_.least_reach) {
    measure_distances(tile);
    if (nearest_capsule(1) > limit) return;
  }
  sheet_.prefetch_corners(reached.triangle);
  reached.distance = std::min(reached.distance, coarse + error);
  reach_neighbours(reached);
  mark_in(reached, stops(), line, first);
  if (has_seed_sets_) mark_in(reached, seeds(), line, first);
}

void ChordOccupancy::mark_in(const Reached& reached, const Marking& marking, const Polyline& line, std::size_t first) {
  if (marking.sets.is_full(reached.triangle)) return;
  const auto& tile = tiles_[reached.triangle];
  if (reached.distance + std::abs(tile.radius) <= depth_inside(marking)) {
    fill(reached.triangle, marking.sets);
  } else {
    if (block_.nearest == unknown) measure_distances(tile);
    mark(reached.triangle, line, first, marking);
  }
}

/// A disc lies in one of the block's capsules if its centre is so far from an axis, less its radius.
float ChordOccupancy::depth_inside(const Marking& marking) const {
  return (marking.share - 3 * distance_slack) * block_.least_reach;
}

inline void ChordOccupancy::fill(std::int32_t triangle, IntervalSets& sets) {
  if (sets.is_full(triangle)) return;
  sets.fill(triangle);
  if (&sets == &unseeded()) changed_.push_back(triangle);
}

/// From the point at hand to the nearest capsule, whose radii are this share of `reach`; negative inside.
float ChordOccupancy::nearest_capsule(float share) const {
  const bool varies = block_.least_reach != block_.greatest_reach;
  return varies ? distance_to_capsules(block_.segments, share) : block_.nearest - share * block_.greatest_reach;
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

/// Chooses the segments whose capsules may take chords of a triangle, in their order; returns how many.
int ChordOccupancy::choose_capsules(std::int32_t triangle, const Marking& marking) {
  const auto corner = [&](const Vector& place) { return float_point(place - origin_); };
  const TriangleQuestion question{
      {corner(sheet_.low(triangle)), corner(sheet_.middle(triangle)), corner(sheet_.high(triangle))},
      std::abs(tiles_[triangle].radius),
      marking.share,
      2 * slack_};
  int chosen = 0;
  unsigned last_was_left = 0;
  for (int group = 0; group < block_.segments.count; group += Segments::group_size) {
    const auto [are_near, lie_before, lie_beyond] = segments_near(block_.segments, group, question);
    // What only the ball at an end can meet is left to the next capsule, or was taken by the one before, unless that
    // left it.
    const unsigned left = are_near & lie_beyond & block_.next_takes[group / Segments::group_size];
    const unsigned taken =
        lie_before & block_.previous_takes[group / Segments::group_size] & ~(left << 1 | last_was_left);
    for (unsigned rest = are_near & ~left & ~taken; rest != 0; rest &= rest - 1) {
      block_.chosen[chosen++] = group + std::countr_zero(rest);
    }
    last_was_left = left >> (Segments::group_size - 1) & 1;
  }
  return chosen;
}

void ChordOccupancy::mark_exactly(std::int32_t triangle, const Polyline& line, std::size_t first,
                                  const Marking& marking) {
  const int count = choose_capsules(triangle, marking);
  if (count == 0) return;
  for (int i = 0; i < count; ++i) {
    const auto segment = block_.chosen[i];
    const auto start = first + static_cast<std::size_t>(segment);
    const double separation = block_.separation[segment];
    marking.marks.ask({triangle, line.points[start], line.points[start + 1],
                       marking.clearance * separation * (1 + guard), guard * separation});
  }
}

double ChordOccupancy::free_share(std::int32_t triangle, const IntervalSets& sets) const {
  if (sets.is_full(triangle)) return 0;
  if (sets.is_empty(triangle)) return 1;
  const auto& crossings = sheet_.crossings[triangle];
  double share = 0;
  for (const auto& gap : sets.gaps(triangle)) {
    share += area_share(crossings, gap.high) - area_share(crossings, gap.low);
  }
  return share;
}

/// Summed in the mesh's order, so that no bit depends on the axes.
double ChordOccupancy::coverage() const {
  constexpr std::int32_t ahead = 16;
  double free = 0;
  for (std::int32_t t = 0, last = sheet_.triangle_count() - 1; t <= last; ++t) {
    stopped_.prefetch(sheet_.ranks[std::min(t + ahead, last)]);
    const auto rank = sheet_.ranks[t];
    if (!stopped_.is_full(rank)) free += free_share(rank, stopped_) * mesh_.triangle_areas()[t];
  }
  return 1 - free / sheet_.directed_area;
}

}  // namespace pectinate::detail
