// SPDX-License-Identifier: MIT
#include "detail/longest_first.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "detail/candidate_tracer.hpp"
#include "detail/candidates.hpp"
#include "detail/self_free_parts.hpp"
#include "detail/sheet.hpp"
#include "detail/trajectories.hpp"
#include "detail/triangle_rings.hpp"

namespace pectinate::detail {
namespace {

/// Lines that hug a placed one are preferred to others of about the same length, where streamlines need more room to
/// start than to go on only half as much.
constexpr double hugging_bonus = 1.05, hugging_bonus_with_room = 1.03;
/// Closed lines come before all open ones: one that winds onto a closed curve would take its place, whatever its
/// length.
constexpr double closed_bonus = 1e6;
/// Beside streamlines this long, in chords, a candidate that hugs them makes others needless that would start in the
/// next ring of triangles; beside those twice as long, in the next two, where these do not reach to the line's other
/// side. They are the first ones of smooth fields: hundreds of candidates beside each, nearly as long and hardly apart,
/// would take most of the time.
constexpr std::size_t long_to_hug = 512;
constexpr int most_hugging_rings = 2;
/// Seeds of hugging lines lie this far outside the band that they hug, in separation distances.
constexpr double hugging_gap = 1e-6;
/// Rings of triangles beside a trajectory of the pool that need no other. The fewer lines there will be, the more it
/// pays to choose them well: beyond this many edges a separation distance the pool is denser, and where streamlines
/// need more room to start than to go on, no triangle is left out.
constexpr int usual_rings = 2, rings_of_dense_pool = 1;
constexpr double sparse_separation = 6;
/// Streamlines this long, in separation distances, need no more room to start than to go on: what the room is asked for
/// is to keep short ones out. On smooth fields much of what they would leave uncovered are long strips.
constexpr double long_length = 9;
/// Narrower gaps between occupied chords hold no streamline.
constexpr double least_gap = 4 * least_position;

/// Of equilateral triangles that take as much area.
double mean_edge_length(const SurfaceMesh& mesh) {
  return std::sqrt(4 / std::numbers::sqrt3 * mesh.area() / static_cast<double>(mesh.triangle_count()));
}

}  // namespace

class LineFiller::Implementation {
 public:
  Implementation(const SurfaceMesh& mesh, const StreamlineTracer& tracer, const LineRules& rules,
                 ChordOccupancy& occupancy, Place place)
      : mean_edge_length_(mean_edge_length(mesh)),
        sheet_(tracer.sheet()),
        crossings_(sheet_.crossings),
        occupancy_(occupancy),
        place_(std::move(place)),
        mark_([this](const Polyline& line) -> const std::vector<std::int32_t>& {
          occupancy_.add(line);
          return occupancy_.changed();
        }),
        candidates_(crossings_.size(), rules.minimum_length,
                    {closed_bonus, occupancy.has_seed_sets() ? hugging_bonus_with_room : hugging_bonus}),
        candidate_tracer_(tracer, occupancy, rules, candidates_),
        served_(crossings_.size()) {}

  bool fill(const std::function<bool()>& go_on) {
    if (!fill_pool(go_on) || !empty_heap(go_on)) return false;
    return fill_all_gaps([&] { return triangles_with_gaps(); }, go_on);
  }

  void mark_with(Mark mark) { mark_ = std::move(mark); }

  void refill(const FreedRegion& freed) {
    const auto always = [] { return true; };
    forget_candidates();
    for (const auto& start : freed.first) place_through(start);
    served_.clear();
    for (const auto t : freed.triangles) {
      if (served_.has(t) || occupancy_.unseeded().is_full(t)) continue;
      for (const auto& gap : occupancy_.unseeded().gaps(t)) {
        if (gap.high - gap.low >= least_gap) add_if_free({t, freed.start_in(gap)});
      }
    }
    empty_heap(always);
    fill_all_gaps([&]() -> const auto& { return freed.triangles; }, always);
  }

 private:
  double separation(std::int32_t triangle) const { return candidate_tracer_.separation(triangle); }

  // Candidates ------------------------------------------------------------------------------------------------------

  /// Trajectories so close that the longest streamlines are never far from one: each triangle is crossed by one, or a
  /// few triangles away from one. False if it was stopped.
  bool fill_pool(const std::function<bool()>& go_on) {
    TriangleMarks has_been_crossed(crossings_.size());
    served_.clear();
    std::vector<std::int32_t> seeds;  // the last one is the next
    const double sparse = sparse_separation * mean_edge_length_;
    const bool is_local = occupancy_.has_seed_sets();
    for (const auto first : sheet_.ranks) {  // in the mesh's order: the sheet's depends on the axes
      if (served_.has(first)) continue;
      for (seeds.push_back(first); !seeds.empty();) {
        const auto t = seeds.back();
        seeds.pop_back();
        if (served_.has(t) || occupancy_.stopped().is_full(t)) continue;
        if (!go_on()) return false;
        const auto stretch = candidate_tracer_.add({t, 0.5}, {false, &served_}, false).stretch();
        if (is_local) {
          serve(stretch);
          push_beside(stretch, seeds);  // on from there: its memory is at hand
        } else {
          std::vector<std::int32_t> crossed;
          for (const auto& chord : candidates_.chords_of(stretch)) {
            if (has_been_crossed.has(chord.triangle())) continue;  // all around it is served
            has_been_crossed.add(chord.triangle());
            crossed.push_back(chord.triangle());
          }
          mark_rings(crossings_, std::move(crossed), separation(t) > sparse ? rings_of_dense_pool : usual_rings,
                     served_);
        }
      }
    }
    return true;
  }

  /// Those beside a trajectory that are not served.
  void push_beside(const Stretch& stretch, std::vector<std::int32_t>& triangles) const {
    for (const auto& chord : candidates_.chords_of(stretch)) {
      for (const auto other : crossings_[chord.triangle()].neighbours) {
        if (other >= 0 && !served_.has(other)) triangles.push_back(other);
      }
    }
  }

  /// Drops what is of no use any more, where it takes much room.
  void make_room() {
    if (!candidates_.needs_room()) return;
    if (candidates_.are_many()) look_again_at_all();
    candidates_.make_room();
    self_free_parts_.forget();
  }

  /// Candidates that lie just outside the band of the streamline placed last.
  void push_hugging(const std::vector<std::int32_t>& changed) {
    served_.clear();
    const int rings = rings_beside_hugging();
    for (const auto t : changed) {
      if (occupancy_.unseeded().is_full(t) || is_served_near(t, rings)) continue;
      make_room();  // what goes for want of it comes back when gaps are filled
      const double gap = hugging_gap * separation(t) / crossings_[t].width;
      occupancy_.unseeded().get_intervals(t, intervals_);
      for (const auto& [low, high] : intervals_) {
        for (const double coordinate : {low - gap, high + gap}) {
          if (!(coordinate > least_position && coordinate < 1 - least_position)) continue;
          if (occupancy_.unseeded().contains(t, coordinate)) continue;
          serve(candidate_tracer_.add({t, coordinate}, {true, &served_}, true).stretch());
        }
      }
    }
  }

  /// Beside the streamline at hand; not so many that they reach across its band.
  int rings_beside_hugging() const {
    const auto wanted = static_cast<int>(std::bit_width(polyline_.triangles.size() / long_to_hug));
    const double across = 2 * separation(polyline_.triangles.front()) / mean_edge_length_ - 1;
    return static_cast<int>(std::clamp(across, 0.0, static_cast<double>(std::min(wanted, most_hugging_rings))));
  }

  /// The triangles that a candidate crosses need no other.
  void serve(const Stretch& candidate) {
    for (const auto& chord : candidates_.chords_of(candidate)) served_.add(chord.triangle());
  }

  /// Is the triangle served, or another so many rings around it?
  bool is_served_near(std::int32_t triangle, int rings) const {
    if (served_.has(triangle)) return true;
    return rings > 0 && std::ranges::any_of(crossings_[triangle].neighbours, [&](std::int32_t beside) {
             return beside >= 0 && is_served_near(beside, rings - 1);
           });
  }

  /// A candidate from there, if that is free.
  void add_if_free(const ChordPlace& start) {
    if (occupancy_.stopped().contains(start.triangle, start.coordinate)) return;
    serve(candidate_tracer_.add(start, {true}, false).stretch());
  }

  /// Places the longest line through there, or of what is left of it, that may be placed; no other candidates stay.
  void place_through(const ChordPlace& start) {
    add_if_free(start);
    const auto before = placed_count_;
    while (placed_count_ == before && candidates_.piece_count() > 0) place_next();
    forget_candidates();
  }

  void forget_candidates() {
    candidates_.clear();
    self_free_parts_.forget();
  }

  /// Until no gap gives a streamline: where all together gave none, they never will. False if it was stopped.
  template <class Triangles>
  bool fill_all_gaps(const Triangles& triangles, const std::function<bool()>& go_on) {
    for (std::int64_t before = -1; before != placed_count_;) {
      before = placed_count_;
      if (!fill_gaps(triangles(), go_on)) return false;
    }
    return true;
  }

  /// In the mesh's order.
  std::vector<std::int32_t> triangles_with_gaps() const {
    std::vector<std::int32_t> triangles;
    for (std::int32_t t = 0; t < sheet_.triangle_count(); ++t) {
      if (!occupancy_.unseeded().is_full(t)) triangles.push_back(t);
    }
    std::ranges::sort(triangles, {}, [&](std::int32_t t) { return sheet_.mesh_triangles[t]; });
    return triangles;
  }

  /// Candidates through all gaps that are left, and what of them fits; false if it was stopped.
  bool fill_gaps(const std::vector<std::int32_t>& triangles, const std::function<bool()>& go_on) {
    for (const auto t : triangles) {
      if (occupancy_.unseeded().is_full(t)) continue;
      for (const auto& gap : occupancy_.unseeded().gaps(t)) {
        if (gap.high - gap.low < least_gap) continue;
        if (!go_on()) return false;
        if (candidates_.are_too_many()) {
          if (!empty_heap(go_on)) return false;
          make_room();
        }
        const double middle = (gap.low + gap.high) / 2;
        if (occupancy_.unseeded().contains(t, middle)) continue;
        const auto before = candidates_.piece_count();
        candidate_tracer_.add({t, middle}, {true}, false);
        if (candidates_.piece_count() == before) occupancy_.retire_seed(t, gap);
      }
    }
    return empty_heap(go_on);
  }

  // Placement -------------------------------------------------------------------------------------------------------

  /// Places pieces, longest first, until none is left; false if it was stopped.
  bool empty_heap(const std::function<bool()>& go_on) {
    while (candidates_.piece_count() > 0) {
      if (!go_on()) return false;
      place_next();
    }
    return true;
  }

  /// Places the piece on top, if it still holds; or what is left of it goes back.
  void place_next() {
    const auto piece = candidates_.pop();
    if (candidates_.trajectory(piece.trajectory()).is_closed()) {
      place_closed(piece);
    } else if (const auto best = longest_free(piece)) {
      const auto& [stretch, length] = *best;
      if (!candidates_.is_first(piece, length)) {
        candidates_.push_back(piece, stretch, length);
      } else if (candidates_.trajectory(piece.trajectory()).is_left_off_at(stretch)) {
        trace_to_ends(stretch, piece.trajectory());
      } else {
        place_best(stretch, piece);
      }
    }
  }

  /// Replaces a stretch at whose end a trajectory was left off.
  void trace_to_ends(const Stretch& stretch, std::int32_t trajectory) {
    const auto& chord = chords_[(stretch.first + stretch.last) / 2];
    candidate_tracer_.add({chord.triangle(), chord.coordinate}, {true}, candidates_.trajectory(trajectory).hugs);
  }

  /// Cuts off from all pieces what is not free any more.
  void look_again_at_all() {
    for (const auto& piece : candidates_.take_pieces()) {
      if (candidates_.trajectory(piece.trajectory()).is_closed()) {
        candidates_.push_back(piece, piece.stretch(), candidates_.length(piece.stretch()));
      } else if (const auto best = longest_free(piece)) {
        candidates_.push_back(piece, best->stretch, best->length);
      }
    }
  }

  struct FreeStretch {
    Stretch stretch;
    double length;
  };

  /// The longest free stretch of a piece; the others go back to the heap.
  std::optional<FreeStretch> longest_free(const Piece& piece) {
    std::optional<FreeStretch> best;
    prefetch(piece.stretch());
    for (auto i = piece.first; i < piece.stretch().last;) {
      if (is_stopped(chords_[i])) {
        ++i;
        continue;
      }
      Stretch run{i, i};
      double run_length = 0;
      bool can_start = false;
      for (; run.last < piece.stretch().last && !is_stopped(chords_[run.last]); ++run.last) {
        run_length += chords_[run.last].length;
        can_start = can_start || !occupancy_.has_seed_sets() || !is_unseeded(chords_[run.last]);
      }
      i = run.last;
      if (!can_start && !is_long(run_length, run)) continue;
      if (best && run_length <= best->length) {
        candidates_.push_back(piece, run, run_length);
      } else {
        if (best) candidates_.push_back(piece, best->stretch, best->length);
        best = {run, run_length};
      }
    }
    return best;
  }

  /// Does it keep d_sep, and needs no more room to start?
  bool is_long(double length, const Stretch& stretch) const {
    return occupancy_.clearance().stop >= 1 && length >= long_length * separation(chords_[stretch.first].triangle());
  }
  /// What is asked of chords is elsewhere in memory. Were it a call, the compiler would leave it out as without effect.
  [[gnu::always_inline]] void prefetch(const Stretch& stretch) const {
    constexpr std::int64_t most = 64;
    const auto last = std::min(stretch.last, stretch.first + most);
    for (auto i = stretch.first; i < last; ++i) occupancy_.stopped().prefetch(chords_[i].triangle());
  }
  bool is_stopped(const Chord& chord) const {
    return occupancy_.stopped().contains(chord.triangle(), chord.coordinate);
  }
  bool is_unseeded(const Chord& chord) const {
    return occupancy_.unseeded().contains(chord.triangle(), chord.coordinate);
  }

  /// Places a stretch of a piece, or, where it comes back to itself, the longest part of it that does not.
  void place_best(const Stretch& stretch, const Piece& piece) {
    const auto trajectory = piece.trajectory();
    polyline_.points.clear();
    const auto part = piece.is_self_free() ? stretch : self_free_part(stretch, trajectory);
    if (part != stretch) {
      push_rest({stretch.first, part.first}, trajectory);
      push_rest({part.last, stretch.last}, trajectory);
      const double length = candidates_.length(part);
      if (!candidates_.is_first(length, trajectory)) {
        candidates_.push(part, length, trajectory, keeps_self_free());
        return;
      }
    }
    if (part != stretch || polyline_.points.empty()) make_polyline(part);
    place_polyline(part, trajectory);
  }

  /// The longest part of a stretch that does not come back to itself. Where d_sep varies, it is that at the beginning.
  Stretch self_free_part(const Stretch& stretch, std::int32_t trajectory) {
    const double distance = separation(chords_[stretch.first].triangle());
    return self_free_parts_.longest(stretch, trajectory, distance, chords_, [&]() -> const auto& {
      make_polyline(stretch);
      return polyline_.points;
    });
  }

  /// Does what does not come back to itself never do so, wherever it begins?
  bool keeps_self_free() const { return candidate_tracer_.separation() > 0; }

  /// Puts back what the longest such part leaves, where possible under the length of its own such part: else what winds
  /// and winds would be looked at again and again.
  void push_rest(const Stretch& rest, std::int32_t trajectory) {
    if (rest.first >= rest.last) return;
    const auto part = keeps_self_free() ? self_free_part(rest, trajectory) : rest;
    candidates_.push(rest, candidates_.length(part), trajectory, keeps_self_free() && part == rest);
  }

  /// Places a closed line if all of it is still free.
  void place_closed(const Piece& piece) {
    const auto chords = candidates_.chords_of(piece.stretch());
    if (std::ranges::any_of(chords, [&](const Chord& chord) { return is_stopped(chord); })) return;
    const bool can_start = !std::ranges::all_of(chords, [&](const Chord& chord) { return is_unseeded(chord); });
    if (!can_start && !is_long(candidates_.length(piece.stretch()), piece.stretch())) return;
    make_polyline(piece.stretch(), true);
    place_polyline(piece.stretch(), piece.trajectory());
  }

  /// Places the stretch whose polyline is at hand.
  void place_polyline(const Stretch& stretch, std::int32_t trajectory) {
    const auto line = make_line(stretch, trajectory);  // while what stops it is not yet in its own neighbourhood
    const auto& changed = mark_(polyline_);
    place_(line);
    ++placed_count_;
    push_hugging(changed);
  }

  void make_polyline(const Stretch& stretch, bool is_closed = false) {
    polyline_.follow(sheet_, candidates_.chords_of(stretch), is_closed);
  }

  PlacedLine make_line(const Stretch& stretch, std::int32_t trajectory) const {
    const auto& whole = candidates_.trajectory(trajectory);
    const auto reason_at = [&](std::int64_t outside) {
      const auto& chord = chords_[outside];
      return is_stopped(chord) ? occupancy_.stop_reason(chord.triangle(), chord.coordinate) : StopReason::near_itself;
    };
    return {candidates_.chords_of(stretch),
            whole.is_closed(),
            {stretch.first == whole.first ? whole.ends[0] : reason_at(stretch.first - 1),
             stretch.last == whole.stretch().last ? whole.ends[1] : reason_at(stretch.last)}};
  }

  double mean_edge_length_;
  const Sheet& sheet_;
  const LargeArray<TriangleCrossings>& crossings_;
  ChordOccupancy& occupancy_;
  Place place_;
  Mark mark_;

  Candidates candidates_;
  CandidateTracer candidate_tracer_;
  Chords& chords_ = candidates_.chords();
  std::int64_t placed_count_ = 0;

  SelfFreeParts self_free_parts_;
  Polyline polyline_;                // of the stretch at hand
  std::vector<Interval> intervals_;  // of the triangle at hand
  TriangleMarks served_;             // need no other candidate: of the pool, then beside the streamline placed last
};

LineFiller::LineFiller(const SurfaceMesh& mesh, const StreamlineTracer& tracer, const LineRules& rules,
                       ChordOccupancy& occupancy, Place place)
    : implementation_(std::make_unique<Implementation>(mesh, tracer, rules, occupancy, std::move(place))) {}

LineFiller::~LineFiller() = default;

bool LineFiller::fill(const std::function<bool()>& go_on) {
  return implementation_->fill(go_on);
}

void LineFiller::mark_with(Mark mark) {
  implementation_->mark_with(std::move(mark));
}

void LineFiller::refill(const FreedRegion& freed) {
  implementation_->refill(freed);
}

}  // namespace pectinate::detail
