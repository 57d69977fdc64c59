// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "detail/capsule.hpp"
#include "detail/capsule_marks.hpp"
#include "detail/interval_sets.hpp"
#include "detail/large_array.hpp"
#include "detail/polyline.hpp"
#include "detail/segments.hpp"
#include "detail/sheet.hpp"
#include "detail/vec.hpp"
#include "pectinate/occupancy.hpp"
#include "pectinate/surface_mesh.hpp"

namespace pectinate::detail {

/// For every triangle, which of its chords come within the separation distance of a streamline: exact for whole
/// segments, anywhere on the surface.
///
/// Distance is Euclidean, between whatever is joined on the surface through triangles that are near. The separation
/// distance is that of the triangle in which the placed streamline lies. The cost of adding a streamline is that of the
/// area that comes within reach. Triangles are those of the tracer's sheet.
class ChordOccupancy {
 public:
  ChordOccupancy(const SurfaceMesh& mesh, const StreamlineTracer& tracer, const Clearance& clearance,
                 const SingularRegion& singular = {});

  /// Chords that no streamline may take, and those at which none may start (a superset).
  const IntervalSets& stopped() const { return stopped_; }
  const IntervalSets& unseeded() const { return has_seed_sets_ ? unseeded_ : stopped_; }
  bool has_seed_sets() const { return has_seed_sets_; }
  bool has_direction(std::int32_t triangle) const { return sheet_.has_direction(triangle); }
  const Clearance& clearance() const { return clearance_; }
  /// Why no streamline may take a chord.
  StopReason stop_reason(std::int32_t triangle, double chord) const {
    return has_singular_ && singular_.contains(triangle, chord) ? StopReason::singularity : StopReason::near_other;
  }

  void add(const Polyline& line);

  /// Takes back all marks in a triangle, those of useless seeds as well; what never was free stays taken.
  void reset(std::int32_t triangle);
  /// Marks chords of a triangle: no streamline may take them, or may start at them.
  void take(std::int32_t triangle, const Interval& chords) {
    stopped_.add(triangle, chords);
    if (has_seed_sets_) unseeded_.add(triangle, chords);
  }
  void take_seeds(std::int32_t triangle, const Interval& chords) { unseeded_.add(triangle, chords); }

  /// Gives up a chord as a seed, when it proved useless.
  void retire_seed(std::int32_t triangle, const Interval& chords);

  /// The triangles in which the streamline added last took seeds, in the order in which they were found, some twice.
  const std::vector<std::int32_t>& changed() const { return changed_; }

  /// The share of the area of all chords in a triangle that is still free for seeds.
  double free_share(std::int32_t triangle) const { return free_share(triangle, unseeded()); }
  /// The same for streamlines to take.
  double uncovered_share(std::int32_t triangle) const { return free_share(triangle, stopped_); }
  /// The share of the surface, of its triangles with a direction, whose chords are taken.
  double coverage() const;

 private:
  /// What is known of a triangle at a glance, in single precision, relative to `origin_`; a cache line holds two.
  struct alignas(32) Tile {
    float x, y, z;
    float radius;                            ///< about the centroid; negative at the surface's border
    std::array<std::int32_t, 3> neighbours;  ///< by Role
    std::uint32_t round;                     ///< in which it was reached last
  };

  /// A stretch of a streamline.
  struct Block {
    Segments segments;
    std::array<double, Segments::most> separation;
    float least_reach = 0, greatest_reach = 0;
    float nearest = 0;  ///< distance from the point at hand to the nearest segment
    /// Fewer and longer segments that are as near to any point as the true ones, but for the error.
    Segments coarse;
    float coarse_error = 0;
    /// By group and bit: a segment's ball at its end lies in the next capsule, that at its start in the one before.
    std::array<std::uint8_t, Segments::most / Segments::group_size> next_takes, previous_takes;
    std::array<int, Segments::most> chosen;  ///< segments whose capsules may take chords of the triangle at hand
  };

  /// One of the two kinds of marks: capsules of radius `clearance`, which is this share of `reach`, marked in `sets`.
  struct Marking {
    double clearance;
    float share;
    IntervalSets& sets;
    CapsuleMarks& marks;
  };

  double free_share(std::int32_t triangle, const IntervalSets& sets) const;
  void make_tiles();
  bool lies_on_border(std::int32_t triangle, Role side) const;
  void keep_out_of(const SingularRegion& region);
  void add_block(const Polyline& line, std::size_t first, std::size_t last);
  void fill_block(const Polyline& line, std::size_t first, std::size_t last);
  void note_who_takes_ends();
  void simplify_block(const Polyline& line, std::size_t first);
  void measure_distances(const Tile& tile);
  /// A triangle that the search has come to, whose centroid is at most so far from the block.
  struct Reached {
    std::int32_t triangle;
    float distance;
  };

  void prefetch(std::int32_t triangle) const {
    __builtin_prefetch(&sheet_.triangles[triangle]);
    __builtin_prefetch(&sheet_.crossings[triangle]);
    stopped_.prefetch(triangle);
  }
  bool is_full(std::int32_t triangle) const { return stopped_.is_full(triangle) && unseeded().is_full(triangle); }
  void reach(std::int32_t triangle, float distance);
  void reach_from(const Tile& from, float distance, std::int32_t triangle);
  void reach_neighbours(const Reached& from);
  void visit_border(Reached reached, const Polyline& line, std::size_t first);
  void mark_in(const Reached& reached, const Marking& marking, const Polyline& line, std::size_t first);
  Marking stops() {
    return {clearance_.stop, static_cast<float>(clearance_.stop / greatest_clearance()), stopped_, stop_marks_};
  }
  Marking seeds() {
    return {clearance_.seed, static_cast<float>(clearance_.seed / greatest_clearance()), unseeded_, seed_marks_};
  }
  /// From the point at hand to the nearest capsule, whose radii are this share of `reach`; negative inside.
  float nearest_capsule(float share) const;
  void mark(std::int32_t triangle, const Polyline& line, std::size_t first, const Marking& marking);
  float depth_inside(const Marking& marking) const;
  void fill(std::int32_t triangle, IntervalSets& sets);
  int choose_capsules(std::int32_t triangle, const Marking& marking);
  void mark_exactly(std::int32_t triangle, const Polyline& line, std::size_t first, const Marking& marking);
  double greatest_clearance() const { return std::max(clearance_.stop, clearance_.seed); }
  double separation(std::int32_t triangle) const { return tracer_.separation_distance(sheet_.mesh_triangle(triangle)); }

  const SurfaceMesh& mesh_;
  const StreamlineTracer& tracer_;
  const Sheet& sheet_;
  Clearance clearance_;
  bool has_seed_sets_, has_singular_;
  IntervalSets stopped_, unseeded_, singular_;
  Vector origin_;
  float slack_;  // of single precision, for the surface's size
  LargeArray<Tile> tiles_;
  std::uint32_t round_ = 0;
  std::vector<Reached> queue_;
  std::vector<std::int32_t> changed_;
  Block block_;
  CapsuleMarks stop_marks_, seed_marks_;
};

}  // namespace pectinate::detail
