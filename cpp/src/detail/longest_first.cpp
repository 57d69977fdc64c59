// SPDX-License-Identifier: MIT
#include "detail/longest_first.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "detail/candidate_source.hpp"
#include "detail/candidates.hpp"
#include "detail/self_free_parts.hpp"
#include "detail/sheet.hpp"
#include "detail/trajectories.hpp"

namespace pectinate::detail {
namespace {

/// Lines that hug a placed one are preferred to others of about the same length, where streamlines need more room to
/// start than to go on only half as much.
constexpr double hugging_bonus = 1.05, hugging_bonus_with_room = 1.03;
/// Closed lines come before all open ones: one that winds onto a closed curve would take its place, whatever its
/// length.
constexpr double closed_bonus = 1e6;
/// Streamlines this long, in separation distances, need no more room to start than to go on: what the room is asked for
/// is to keep short ones out. On smooth fields much of what they would leave uncovered are long strips.
constexpr double long_length = 9;
}  // namespace

class LineFiller::Implementation {
 public:
  Implementation(const SurfaceMesh& mesh, const StreamlineTracer& tracer, const LineRules& rules,
                 ChordOccupancy& occupancy, Place place)
      : sheet_(tracer.sheet()),
        occupancy_(occupancy),
        place_(std::move(place)),
        mark_([this](const Polyline& line) -> const std::vector<std::int32_t>& {
          occupancy_.add(line);
          return occupancy_.changed();
        }),
        candidates_(sheet_.crossings.size(), rules.minimum_length,
                    {closed_bonus, occupancy.has_seed_sets() ? hugging_bonus_with_room : hugging_bonus}),
        source_(mesh, tracer, rules, occupancy, candidates_) {}

  bool fill(const std::function<bool()>& go_on) {
    if (!source_.fill_pool(go_on) || !empty_heap(go_on)) return false;
    return fill_all_gaps([&] { return triangles_with_gaps(); }, go_on);
  }

  void mark_with(Mark mark) { mark_ = std::move(mark); }

  void refill(const FreedRegion& freed) {
    const auto always = [] { return true; };
    forget_candidates();
    for (const auto& start : freed.first) place_through(start);
    source_.add_in_gaps(freed.triangles, freed.start_in);
    empty_heap(always);
    fill_all_gaps([&]() -> const auto& { return freed.triangles; }, always);
  }

 private:
  double separation(std::int32_t triangle) const { return source_.separation(triangle); }

  // Candidates ------------------------------------------------------------------------------------------------------

  /// Drops what is of no use any more, where it takes much room.
  void make_room() {
    if (!candidates_.needs_room()) return;
    if (candidates_.are_many()) look_again_at_all();
    candidates_.make_room();
    self_free_parts_.forget();
  }

  /// Places the longest line through there, or of what is left of it, that may be placed; no other candidates stay.
  void place_through(const ChordPlace& start) {
    if (source_.is_free(start)) source_.add(start);
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
    std::ranges::sort(triangles, {}, [&](std::int32_t t) { return sheet_.mesh_triangle(t); });
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
        source_.add({t, middle});
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
      if (!candidates_.is_first(piece, stretch, length)) {
        candidates_.push_back(piece, stretch, length);
      } else if (is_left_off_at(stretch, piece.trajectory())) {
        trace_to_ends(stretch);
      } else {
        place_best(stretch, piece);
      }
    }
  }

  bool is_left_off_at(const Stretch& stretch, std::int32_t trajectory) const {
    return candidates_.trajectory(trajectory).is_left_off_at(stretch);
  }

  /// Puts, in place of a stretch at whose end a trajectory was left off, all of the curve that is free.
  void trace_to_ends(const Stretch& stretch) {
    const auto& chord = chords_[(stretch.first + stretch.last) / 2];
    const ChordPlace middle{chord.triangle(), chord.coordinate};
    make_room();
    source_.add(middle);
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
      // Where it was left off, more of it may be free.
      if (!can_start && !is_long(run_length, run) && !is_left_off_at(run, piece.trajectory())) continue;
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
      if (!candidates_.is_first(part, length, trajectory)) {
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
  bool keeps_self_free() const { return source_.separation() > 0; }

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
    source_.add_hugging(polyline_, changed, [this] { make_room(); });
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
    const bool is_cut[] = {stretch.first != whole.first, stretch.last != whole.stretch().last};
    return {
        candidates_.chords_of(stretch),
        whole.is_closed(),
        {is_cut[0] ? reason_at(stretch.first - 1) : whole.ends[0], is_cut[1] ? reason_at(stretch.last) : whole.ends[1]},
        {is_cut[0], is_cut[1]}};
  }

  const Sheet& sheet_;
  ChordOccupancy& occupancy_;
  Place place_;
  Mark mark_;

  Candidates candidates_;
  CandidateSource source_;
  Chords& chords_ = candidates_.chords();
  std::int64_t placed_count_ = 0;

  SelfFreeParts self_free_parts_;
  Polyline polyline_;  // of the stretch at hand
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
