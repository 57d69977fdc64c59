// SPDX-License-Identifier: MIT
#include "detail/candidates.hpp"

#include <algorithm>
#include <utility>

namespace pectinate::detail {
namespace {

/// Chords per triangle: before there are more than the first, none are dropped; more than the second are too many.
constexpr double most_usual_chords = 3.5, too_many_chords = 12;
/// With more than this, pieces are first cut to what is still free.
constexpr double many_chords = 7;
/// Memory is reserved for more, because it costs nothing as long as it is not written to; to move what is stored to a
/// larger place would take twice as much.
constexpr double most_reserved_chords = 14, most_reserved_pieces = 2;
/// Of the chords that are left when some are dropped, so many may be added before it is done again.
constexpr double growth = 0.25;

}  // namespace

Candidates::Candidates(std::size_t triangle_count, double minimum_length, const Bonus& bonus)
    : minimum_length_(minimum_length), bonus_(bonus) {
  const auto times = [&](double factor) {
    return static_cast<std::size_t>(factor * static_cast<double>(triangle_count));
  };
  most_chords_ = times(most_usual_chords);
  many_chords_ = times(many_chords);
  too_many_chords_ = times(too_many_chords);
  chords_.reserve(times(most_reserved_chords));
  trajectories_.reserve(times(most_reserved_pieces));
  heap_.reserve(times(most_reserved_pieces));
}

double Candidates::length(const Stretch& stretch) const {
  double sum = 0;
  for (const auto& chord : chords_of(stretch)) sum += chord.length;
  return sum;
}

void Candidates::add(const Trajectory& trajectory) {
  trajectories_.push_back(trajectory);
  push(trajectory.stretch(), length(trajectory.stretch()), static_cast<std::int32_t>(trajectories_.size()) - 1);
}

void Candidates::push(const Stretch& stretch, double length, std::int32_t trajectory, bool is_self_free) {
  insert({key(length, trajectory), stretch, trajectory, is_self_free}, length);
}

void Candidates::push_back(const Piece& piece, const Stretch& stretch, double length) {
  insert({key(piece, length), stretch, piece.trajectory(), piece.is_self_free()}, length);
}

void Candidates::insert(const Piece& piece, double length) {
  if (piece.length <= 0 || !is_long_enough(piece.stretch(), length, piece.trajectory())) return;
  heap_.push_back(piece);
  std::push_heap(heap_.begin(), heap_.end());
}

Piece Candidates::pop() {
  std::pop_heap(heap_.begin(), heap_.end());
  const auto piece = heap_.back();
  heap_.pop_back();
  prefetch_next();
  return piece;
}

/// The next piece is elsewhere in memory.
void Candidates::prefetch_next() const {
  if (heap_.empty()) return;
  __builtin_prefetch(&trajectories_[heap_.front().trajectory()]);
  constexpr std::int64_t at_first = 32, chords_per_line = 64 / sizeof(Chord);
  const auto [first, last] = heap_.front().stretch();
  for (auto i = first; i < std::min(last, first + at_first); i += chords_per_line) __builtin_prefetch(&chords_[i]);
}

void Candidates::clear() {
  chords_.clear();
  trajectories_.clear();
  heap_.clear();
}

std::vector<Piece> Candidates::take_pieces() {
  std::vector<Piece> room;
  room.reserve(heap_.capacity());
  return std::exchange(heap_, std::move(room));
}

void Candidates::make_room() {
  std::size_t held = 0;
  for (const auto& piece : heap_) held += static_cast<std::size_t>(piece.length);
  if (held > too_many_chords_ / 8 * 7) drop_shortest();
  drop_dead_chords();
}

/// Keeps the longest pieces, three quarters as many chords as would be too many.
void Candidates::drop_shortest() {
  std::sort(heap_.begin(), heap_.end(), [](const Piece& a, const Piece& b) { return b < a; });
  auto room = static_cast<std::int64_t>(too_many_chords_ / 4 * 3);
  std::size_t kept = 0;
  for (; kept < heap_.size() && room > 0; ++kept) room -= heap_[kept].length;
  heap_.erase(heap_.begin() + static_cast<std::ptrdiff_t>(kept), heap_.end());
}

void Candidates::drop_dead_chords() {
  std::sort(heap_.begin(), heap_.end(), [](const Piece& a, const Piece& b) { return a.first < b.first; });
  std::vector<Trajectory> kept;
  kept.reserve(heap_.size());
  std::int64_t read = 0, written = 0, shift = 0;  // chords up to `read` are where they shall be, or dropped
  std::int32_t trajectory = -1;
  for (auto& piece : heap_) {
    const auto& whole = trajectories_[piece.trajectory()];
    const auto first = std::max(piece.stretch().first - 1, whole.stretch().first);
    const auto last = std::min(piece.stretch().last + 1, whole.stretch().last);
    if (piece.trajectory() != trajectory || first > read) {
      shift = written - first;
      kept.push_back({{written, written}, whole.ends, whole.hugs});
      trajectory = piece.trajectory();
      read = first;
    }
    std::move(chords_.begin() + read, chords_.begin() + last, chords_.begin() + written);
    kept.back().length += static_cast<std::int32_t>(last - read);
    written += last - read;
    read = last;
    piece.first += shift;
    piece.set_trajectory(static_cast<std::int32_t>(kept.size()) - 1);
  }
  chords_.resize(written);
  trajectories_.assign(kept.begin(), kept.end());
  most_chords_ = std::max(most_chords_, static_cast<std::size_t>((1 + growth) * static_cast<double>(written)));
  std::make_heap(heap_.begin(), heap_.end());
}

}  // namespace pectinate::detail
