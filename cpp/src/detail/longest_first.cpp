// SPDX-License-Identifier: MIT
#include "detail/longest_first.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "detail/self_free_run.hpp"
#include "detail/sheet.hpp"
#include "detail/trajectories.hpp"
#include "detail/visited_chords.hpp"

namespace pectinate::detail {
namespace {

/// Prefers lines that hug a placed one to others of about the same length.
constexpr double hugging_bonus = 1.05;
/// Seeds of hugging lines lie this far outside the band that they hug, in separation distances.
constexpr double hugging_gap = 1e-6;
/// Rings of triangles beside a trajectory of the pool that need no other. The fewer lines there will be, the more it
/// pays to choose them well: beyond this many edges a separation distance the pool is denser, and where streamlines
/// need more room to start than to go on, no triangle is left out.
constexpr int usual_rings = 2, rings_of_dense_pool = 1;
constexpr double sparse_separation = 6;
/// Room for stored chords per triangle, seldom all used: when it is, those that no candidate needs are dropped.
constexpr std::size_t most_usual_chords = 4;
/// Narrower gaps between occupied chords hold no streamline.
constexpr double least_gap = 4 * least_position;

class LongestFirst {
 public:
  LongestFirst(const SurfaceMesh& mesh, const StreamlineTracer& tracer, double minimum_length,
               ChordOccupancy& occupancy, const std::function<void(const PlacedLine&)>& place)
      : mesh_(mesh),
        tracer_(tracer),
        sheet_(tracer.sheet()),
        crossings_(sheet_.crossings),
        separation_(tracer.options().separation_distances.empty() ? tracer.options().separation_distance : 0),
        minimum_length_(minimum_length),
        occupancy_(occupancy),
        place_(place),
        most_chords_(most_usual_chords * crossings_.size()),
        hugged_(crossings_.size(), 0) {}

  bool run(const std::function<bool()>& go_on) {
    chords_.reserve(most_chords_);
    if (!fill_pool(go_on) || !empty_heap(go_on)) return false;
    // Where all gaps together gave no streamline, they never will.
    for (std::int64_t before = -1; before != placed_count_ && push_gaps(go_on);) {
      before = placed_count_;
      if (!empty_heap(go_on)) return false;
    }
    return true;
  }

 private:
  double separation(std::int32_t triangle) const {
    return separation_ > 0 ? separation_ : tracer_.separation_distance(sheet_.mesh_triangles[triangle]);
  }

  // Tracing ---------------------------------------------------------------------------------------------------------

  /// Appends the chords that follow on one, leaving through a side; stops at occupied ones if asked.
  StopReason walk(const Chord& start, Role exit, bool mind_others, Chords& chords) {
    auto triangle = start.triangle();
    double coordinate = start.coordinate;
    const auto max_steps = tracer_.options().max_steps;
    for (std::int64_t step = 0; step < max_steps; ++step) {
      const auto way_out = crossings_[triangle].exit(exit);
      if (way_out.triangle < 0) return way_out.stop_reason;
      const double position = edge_position(crossings_[triangle], exit, coordinate);
      triangle = way_out.triangle;
      const auto& crossings = crossings_[triangle];
      coordinate = chord_coordinate(crossings, way_out.role, position);
      if (mind_others && occupancy_.stopped().contains(triangle, coordinate)) return StopReason::near_other;
      if (visited_.revisit(triangle, coordinate, crossings.width, separation(triangle))) {
        return StopReason::near_itself;
      }
      exit = exit_role(crossings, way_out.role, coordinate);
      chords.push_back(make_chord(triangle, coordinate, exit == low_high));
    }
    return StopReason::max_steps;
  }

  Chord make_chord(std::int32_t triangle, double coordinate, bool leaves_through_low_high) const {
    const auto length = static_cast<float>(chord_length(crossings_[triangle], coordinate));
    return {coordinate, length, 2 * triangle + leaves_through_low_high};
  }

  /// Traces both ways from a chord and stores the trajectory as a candidate.
  const Trajectory& add_trajectory(std::int32_t triangle, double coordinate, bool mind_others, double bonus) {
    const auto& crossings = crossings_[triangle];
    const Chord start = make_chord(triangle, coordinate, true);
    visited_.start(crossings_.size());
    visited_.revisit(triangle, coordinate, crossings.width, 0);
    scratch_.clear();
    Trajectory trajectory{{std::ssize(chords_), 0}, {}, bonus};
    trajectory.ends[0] = walk(start, exit_role(crossings, low_high, coordinate), mind_others, scratch_);
    // Traced away from the start: turned round, each chord leaves through the side that it was entered through.
    for (auto chord = scratch_.rbegin(); chord != scratch_.rend(); ++chord) {
      chords_.push_back({chord->coordinate, chord->length, chord->code ^ 1});
    }
    chords_.push_back(start);
    trajectory.ends[1] = walk(start, low_high, mind_others, chords_);
    trajectory.stretch.last = std::ssize(chords_);
    trajectories_.push_back(trajectory);
    push(trajectory.stretch, length(trajectory.stretch), static_cast<std::int32_t>(trajectories_.size()) - 1);
    return trajectories_.back();
  }

  // Candidates ------------------------------------------------------------------------------------------------------

  double length(const Stretch& stretch) const {
    double sum = 0;
    for (auto i = stretch.first; i < stretch.last; ++i) sum += chords_[i].length;
    return sum;
  }

  /// Puts a stretch of known length into the heap.
  void push(const Stretch& stretch, double length, std::int32_t trajectory, bool is_self_free = false) {
    if (stretch.first < stretch.last && length >= minimum_length_) {
      heap_.push_back({length * trajectories_[trajectory].bonus, stretch, trajectory, is_self_free});
      std::push_heap(heap_.begin(), heap_.end());
    }
  }

  Piece pop() {
    std::pop_heap(heap_.begin(), heap_.end());
    const auto piece = heap_.back();
    heap_.pop_back();
    return piece;
  }

  /// Keeps of all trajectories only what pieces in the heap hold, and the chords at which they were cut off.
  void drop_dead_chords() {
    std::sort(heap_.begin(), heap_.end(),
              [](const Piece& a, const Piece& b) { return a.stretch.first < b.stretch.first; });
    std::vector<Trajectory> kept;
    std::int64_t read = 0, written = 0, shift = 0;  // chords up to `read` are where they shall be, or dropped
    std::int32_t trajectory = -1;
    for (auto& piece : heap_) {
      const auto& whole = trajectories_[piece.trajectory];
      const auto first = std::max(piece.stretch.first - 1, whole.stretch.first);
      const auto last = std::min(piece.stretch.last + 1, whole.stretch.last);
      if (kept.empty() || piece.trajectory != trajectory || first > read) {
        shift = written - first;
        kept.push_back({{written, written}, whole.ends, whole.bonus});
        trajectory = piece.trajectory;
        read = first;
      }
      std::move(chords_.begin() + read, chords_.begin() + last, chords_.begin() + written);
      written += last - read;
      read = last;
      kept.back().stretch.last = written;
      piece.stretch = {piece.stretch.first + shift, piece.stretch.last + shift};
      piece.trajectory = static_cast<std::int32_t>(kept.size()) - 1;
    }
    chords_.resize(written);
    trajectories_ = std::move(kept);
    self_approaches_.clear();
    most_chords_ = std::max<std::size_t>(most_chords_, written + written / 2);
    chords_.reserve(most_chords_);
    std::make_heap(heap_.begin(), heap_.end());
  }

  /// Trajectories so close that the longest streamlines are never far from one: each triangle is crossed by one, or a
  /// few triangles away from one. False if it was stopped.
  bool fill_pool(const std::function<bool()>& go_on) {
    std::vector<bool> served(crossings_.size(), false);
    std::vector<std::int32_t> seeds;  // the last one is the next
    const double sparse = sparse_separation * mean_edge_length();
    for (const auto first : sheet_.ranks) {  // in the mesh's order: the sheet's depends on the axes
      for (seeds.push_back(first); !seeds.empty();) {
        const auto t = seeds.back();
        seeds.pop_back();
        if (served[t] || occupancy_.stopped().is_full(t)) continue;
        if (!go_on()) return false;
        const auto stretch = add_trajectory(t, 0.5, false, 1).stretch;
        if (occupancy_.has_seed_sets()) {
          const auto beside = serve(stretch, 0, served);  // on from there: where the last one was, memory is at hand
          seeds.insert(seeds.end(), beside.begin(), beside.end());
        } else {
          serve(stretch, separation(t) > sparse ? rings_of_dense_pool : usual_rings, served);
        }
      }
    }
    return true;
  }

  double mean_edge_length() const {
    double sum = 0;
    for (const double length : mesh_.edge_lengths()) sum += length;
    return sum / static_cast<double>(mesh_.edge_lengths().size());
  }

  /// Marks the triangles of a stretch and those up to `rings` triangles away; returns those beside them.
  std::vector<std::int32_t> serve(const Stretch& stretch, int rings, std::vector<bool>& served) const {
    std::vector<std::int32_t> front, next;
    for (auto i = stretch.first; i < stretch.last; ++i) front.push_back(chords_[i].triangle());
    for (const auto t : front) served[t] = true;
    for (int ring = 0; ring <= rings; ++ring, front.swap(next)) {
      next.clear();
      for (const auto t : front) {
        for (const auto other : crossings_[t].neighbours) {
          if (other < 0 || served[other]) continue;
          if (ring < rings) served[other] = true;
          next.push_back(other);
        }
      }
    }
    return front;
  }

  /// Candidates that lie just outside the band of the streamline placed last.
  void push_hugging() {
    if (chords_.size() > most_chords_ / 8 * 7) drop_dead_chords();  // there is room for those that come now
    ++round_;
    for (const auto t : occupancy_.changed()) {
      if (hugged_[t] == round_ || occupancy_.unseeded().is_full(t)) continue;
      hugged_[t] = round_;
      const double gap = hugging_gap * separation(t) / crossings_[t].width;
      for (const auto& [low, high] : occupancy_.unseeded().intervals(t)) {
        for (const double coordinate : {low - gap, high + gap}) {
          if (!(coordinate > least_position && coordinate < 1 - least_position)) continue;
          if (occupancy_.unseeded().contains(t, coordinate)) continue;
          const auto stretch = add_trajectory(t, coordinate, true, hugging_bonus).stretch;
          for (auto i = stretch.first; i < stretch.last; ++i) hugged_[chords_[i].triangle()] = round_;
        }
      }
    }
  }

  /// A candidate through every gap that is left; false if none is, or if it was stopped.
  bool push_gaps(const std::function<bool()>& go_on) {
    bool any = false;
    for (const auto t : sheet_.ranks) {
      if (occupancy_.unseeded().is_full(t)) continue;
      for (const auto& gap : occupancy_.unseeded().gaps(t)) {
        if (gap.high - gap.low < least_gap) continue;
        if (!go_on()) return true;  // the heap says so too
        if (length(add_trajectory(t, (gap.low + gap.high) / 2, true, 1).stretch) < minimum_length_) {
          occupancy_.retire_seed(t, gap);
        } else {
          any = true;
        }
      }
    }
    return any;
  }

  // Placement -------------------------------------------------------------------------------------------------------

  /// Places pieces, longest first, until none is left; false if it was stopped.
  bool empty_heap(const std::function<bool()>& go_on) {
    while (!heap_.empty()) {
      if (!go_on()) return false;
      const auto piece = pop();
      if (!heap_.empty()) prefetch(heap_.front().stretch);
      if (const auto best = longest_free(piece)) {
        const auto& [stretch, length] = *best;
        if (is_still_first(length, piece.trajectory)) {
          place_best(stretch, piece);
        } else {
          push(stretch, length, piece.trajectory, piece.is_self_free);
        }
      }
    }
    return true;
  }

  /// The next piece is elsewhere in memory.
  void prefetch(const Stretch& stretch) const {
    constexpr std::int64_t at_first = 32, chords_per_line = 64 / sizeof(Chord);
    for (auto i = stretch.first; i < std::min(stretch.last, stretch.first + at_first); i += chords_per_line) {
      __builtin_prefetch(&chords_[i]);
    }
  }

  bool is_still_first(double now, std::int32_t trajectory) const {
    return now >= minimum_length_ && (heap_.empty() || now * trajectories_[trajectory].bonus >= heap_.front().key);
  }

  struct FreeStretch {
    Stretch stretch;
    double length;
  };

  /// The longest free stretch of a piece; the others go back to the heap.
  std::optional<FreeStretch> longest_free(const Piece& piece) {
    std::optional<FreeStretch> best;
    for (auto i = piece.stretch.first; i < piece.stretch.last;) {
      if (is_stopped(chords_[i])) {
        ++i;
        continue;
      }
      Stretch run{i, i};
      double run_length = 0;
      bool can_start = false;
      for (; run.last < piece.stretch.last && !is_stopped(chords_[run.last]); ++run.last) {
        run_length += chords_[run.last].length;
        can_start = can_start || !occupancy_.has_seed_sets() || !is_unseeded(chords_[run.last]);
      }
      i = run.last;
      if (!can_start) continue;
      if (best && run_length <= best->length) {
        push(run, run_length, piece.trajectory, piece.is_self_free);
      } else {
        if (best) push(best->stretch, best->length, piece.trajectory, piece.is_self_free);
        best = {run, run_length};
      }
    }
    return best;
  }

  bool is_stopped(const Chord& chord) const {
    return occupancy_.stopped().contains(chord.triangle(), chord.coordinate);
  }
  bool is_unseeded(const Chord& chord) const {
    return occupancy_.unseeded().contains(chord.triangle(), chord.coordinate);
  }

  /// Places a stretch of a piece, or, where it comes back to itself, the longest part of it that does not.
  void place_best(const Stretch& stretch, const Piece& piece) {
    make_polyline(stretch);
    const auto part = piece.is_self_free ? stretch : longest_self_free_part(stretch, piece.trajectory);
    if (part.last - part.first < stretch.last - stretch.first) {
      const Stretch before{stretch.first, part.first}, behind{part.last, stretch.last};
      push(before, length(before), piece.trajectory);
      push(behind, length(behind), piece.trajectory);
      const double part_length = length(part);
      if (!is_still_first(part_length, piece.trajectory)) {
        push(part, part_length, piece.trajectory, separation_ > 0);  // where it varies, a part's may be another
        return;
      }
      make_polyline(part);
    }
    const auto line = make_line(part, piece.trajectory);  // while what stops it is not yet in its own neighbourhood
    occupancy_.add(polyline_);
    place_(line);
    ++placed_count_;
    push_hugging();
  }

  /// Of the stretch whose polyline is at hand.
  Stretch longest_self_free_part(const Stretch& stretch, std::int32_t trajectory) {
    auto& known = self_approaches_[trajectory];
    // Where the distance varies, it is that at the stretch's beginning.
    if (separation_ == 0 || stretch.first < known.stretch.first || stretch.last > known.stretch.last) {
      const double distance = separation(chords_[stretch.first].triangle());
      known = {stretch, self_free_starts(polyline_.points, distance, 2 * distance)};
    }
    const auto before = stretch.first - known.stretch.first;
    const auto run = longest_self_free_run(polyline_.points, std::span(known.starts).subspan(before),
                                           static_cast<std::int32_t>(before));
    const Stretch part{stretch.first + static_cast<std::int64_t>(run.first),
                       stretch.first + static_cast<std::int64_t>(run.last)};
    if (part.last - part.first == stretch.last - stretch.first) self_approaches_.erase(trajectory);
    return part;
  }

  void make_polyline(const Stretch& stretch) {
    polyline_.points.clear();
    polyline_.triangles.clear();
    polyline_.chords.clear();
    for (auto i = stretch.first; i < stretch.last; ++i) {
      const auto& chord = chords_[i];
      if (i == stretch.first) polyline_.points.push_back(point_on(chord, entry_side(chord)));
      polyline_.points.push_back(point_on(chord, exit_side(chord)));
      polyline_.triangles.push_back(chord.triangle());
      polyline_.chords.push_back(chord.coordinate);
    }
  }

  Vector point_on(const Chord& chord, Role side) const {
    return sheet_.point(chord.triangle(), side, chord.coordinate);
  }
  Role short_side(const Chord& chord) const {
    return exit_role(crossings_[chord.triangle()], low_high, chord.coordinate);
  }
  Role exit_side(const Chord& chord) const { return chord.leaves_through_low_high() ? low_high : short_side(chord); }
  Role entry_side(const Chord& chord) const { return chord.leaves_through_low_high() ? short_side(chord) : low_high; }

  /// Weights of the corners of the chord's mesh triangle at its end on a side.
  Vec3 barycentric(const Chord& chord, Role side) const {
    const auto& crossings = crossings_[chord.triangle()];
    const double along = side_position(crossings, side, chord.coordinate);
    const int middle = crossings.middle, low = (middle + 1) % 3, high = (middle + 2) % 3;
    Vec3 weights{0, 0, 0};
    weights[side == middle_high ? middle : low] = 1 - along;
    weights[side == low_middle ? middle : high] = along;
    return weights;
  }

  /// The streamline of the stretch whose polyline is at hand.
  PlacedLine make_line(const Stretch& stretch, std::int32_t trajectory) const {
    PlacedLine line;
    line.points = polyline_.points;
    for (auto i = stretch.first; i < stretch.last; ++i) {
      line.triangles.push_back(sheet_.mesh_triangles[chords_[i].triangle()]);
      line.barycentric.push_back(barycentric(chords_[i], entry_side(chords_[i])));
    }
    const auto& last = chords_[stretch.last - 1];
    line.barycentric.push_back(barycentric(last, exit_side(last)));
    for (std::size_t i = 1; i < polyline_.points.size(); ++i) {
      line.length += (polyline_.points[i] - polyline_.points[i - 1]).norm();
    }
    const auto& whole = trajectories_[trajectory];
    const auto reason_at = [&](std::int64_t outside) {
      return is_stopped(chords_[outside]) ? StopReason::near_other : StopReason::near_itself;
    };
    line.stop_reasons[0] = stretch.first == whole.stretch.first ? whole.ends[0] : reason_at(stretch.first - 1);
    line.stop_reasons[1] = stretch.last == whole.stretch.last ? whole.ends[1] : reason_at(stretch.last);
    return line;
  }

  const SurfaceMesh& mesh_;
  const StreamlineTracer& tracer_;
  const Sheet& sheet_;
  const LargeArray<TriangleCrossings>& crossings_;
  double separation_;  // 0 where it varies
  double minimum_length_;
  ChordOccupancy& occupancy_;
  const std::function<void(const PlacedLine&)>& place_;

  Chords chords_;  // of all trajectories, one after the other
  std::vector<Trajectory> trajectories_;
  std::vector<Piece> heap_;  // the first is the longest
  std::size_t most_chords_;  // before dead ones are dropped
  std::int64_t placed_count_ = 0;

  /// Of a stretch, where its parts come back to themselves; it takes long to find, and many parts are looked at.
  struct SelfApproaches {
    Stretch stretch{0, 0};
    std::vector<std::int32_t> starts;
  };
  std::unordered_map<std::int32_t, SelfApproaches> self_approaches_;  // per trajectory, where it does

  VisitedChords visited_;
  Chords scratch_;
  Polyline polyline_;                  // of the stretch at hand
  std::vector<std::uint32_t> hugged_;  // per triangle: the last streamline beside which a candidate crosses it
  std::uint32_t round_ = 0;
};

}  // namespace

bool place_longest_first(const SurfaceMesh& mesh, const StreamlineTracer& tracer, double minimum_length,
                         ChordOccupancy& occupancy, const std::function<void(const PlacedLine&)>& place,
                         const std::function<bool()>& go_on) {
  return LongestFirst(mesh, tracer, minimum_length, occupancy, place).run(go_on);
}

}  // namespace pectinate::detail
