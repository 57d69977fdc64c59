// SPDX-License-Identifier: MIT
#include "detail/candidates.hpp"

#include <algorithm>
#include <utility>

namespace pectinate::detail {
namespace {

/// Stored chords per triangle: for so many there is room at first, and with so many it is enough.
constexpr std::size_t most_usual_chords = 4, too_many_chords = 16;

}  // namespace

Candidates::Candidates(std::size_t triangle_count, double minimum_length)
    : minimum_length_(minimum_length),
      most_chords_(most_usual_chords * triangle_count),
      too_many_chords_(too_many_chords * triangle_count) {
  chords_.reserve(most_chords_);
}

double Candidates::length(const Stretch& stretch) const {
  double sum = 0;
  for (const auto& chord : chords_of(stretch)) sum += chord.length;
  return sum;
}

void Candidates::add(const Trajectory& trajectory) {
  trajectories_.push_back(trajectory);
  push(trajectory.stretch, length(trajectory.stretch), static_cast<std::int32_t>(trajectories_.size()) - 1);
}

void Candidates::push(const Stretch& stretch, double length, std::int32_t trajectory, bool is_self_free) {
  if (stretch.first >= stretch.last || length < minimum_length_) return;
  heap_.push_back({length * trajectories_[trajectory].bonus, stretch, trajectory, is_self_free});
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
  constexpr std::int64_t at_first = 32, chords_per_line = 64 / sizeof(Chord);
  const auto [first, last] = heap_.front().stretch;
  for (auto i = first; i < std::min(last, first + at_first); i += chords_per_line) __builtin_prefetch(&chords_[i]);
}

bool Candidates::is_first(double length, std::int32_t trajectory) const {
  return length >= minimum_length_ && (heap_.empty() || length * trajectories_[trajectory].bonus >= heap_.front().key);
}

bool Candidates::make_room() {
  if (!are_too_many() && chords_.size() <= most_chords_ / 8 * 7) return false;
  std::size_t held = 0;
  for (const auto& piece : heap_) held += static_cast<std::size_t>(piece.stretch.last - piece.stretch.first);
  if (held > too_many_chords_) drop_shortest();
  drop_dead_chords();
  return true;
}

/// Keeps the longest pieces, half as many chords as would be too many.
void Candidates::drop_shortest() {
  std::sort(heap_.begin(), heap_.end(), [](const Piece& a, const Piece& b) { return b < a; });
  auto room = static_cast<std::int64_t>(too_many_chords_ / 2);
  std::size_t kept = 0;
  for (; kept < heap_.size() && room > 0; ++kept) room -= heap_[kept].stretch.last - heap_[kept].stretch.first;
  heap_.resize(kept);
}

void Candidates::drop_dead_chords() {
  std::sort(heap_.begin(), heap_.end(),
            [](const Piece& a, const Piece& b) { return a.stretch.first < b.stretch.first; });
  std::vector<Trajectory> kept;
  std::int64_t read = 0, written = 0, shift = 0;  // chords up to `read` are where they shall be, or dropped
  std::int32_t trajectory = -1;
  for (auto& piece : heap_) {
    const auto& whole = trajectories_[piece.trajectory];
    const auto first = std::max(piece.stretch.first - 1, whole.stretch.first);
    const auto last = std::min(piece.stretch.last + 1, whole.stretch.last);
    if (piece.trajectory != trajectory || first > read) {
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
  most_chords_ = std::max<std::size_t>(most_chords_, written + written / 2);
  chords_.reserve(most_chords_);
  std::make_heap(heap_.begin(), heap_.end());
}

}  // namespace pectinate::detail
