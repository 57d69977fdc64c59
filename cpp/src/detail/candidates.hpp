// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "detail/trajectories.hpp"

namespace pectinate::detail {

/// What makes pieces come before others of the same length; factors of the length.
struct Bonus {
  double closed, hugging;
};

/// Trajectories, stored as chords, and a heap of the pieces of them that may still be placed, longest first.
class Candidates {
 public:
  /// Pieces shorter than `minimum_length` are none.
  Candidates(std::size_t triangle_count, double minimum_length, const Bonus& bonus);

  /// All chords, one trajectory after the other; who adds some makes a trajectory of them.
  Chords& chords() { return chords_; }
  std::span<const Chord> chords_of(const Stretch& stretch) const {
    return {chords_.data() + stretch.first, chords_.data() + stretch.last};
  }
  double length(const Stretch& stretch) const;

  const Trajectory& trajectory(std::int32_t index) const { return trajectories_[index]; }
  /// The whole of it becomes a piece.
  void add(const Trajectory& trajectory);

  std::size_t piece_count() const { return heap_.size(); }
  /// Puts a stretch into the heap under a length: its own, or that of what may be placed of it.
  void push(const Stretch& stretch, double length, std::int32_t trajectory, bool is_self_free = false);
  /// Puts a stretch of a piece back, under its own length or, if less, that of the piece.
  void push_back(const Piece& piece, const Stretch& stretch, double length);
  /// Takes the longest piece out; there must be one.
  Piece pop();
  /// Would a stretch of this length come first? And one of a piece put back?
  bool is_first(const Stretch& stretch, double length, std::int32_t trajectory) const {
    return is_long_enough(stretch, length, trajectory) && comes_first(key(length, trajectory));
  }
  bool is_first(const Piece& piece, const Stretch& stretch, double length) const {
    return is_long_enough(stretch, length, piece.trajectory()) && comes_first(key(piece, length));
  }

  /// Forgets all trajectories and pieces.
  void clear();

  /// Where trajectories run on and on beside one another they might take any amount of memory.
  bool are_too_many() const { return chords_.size() > too_many_chords_; }
  bool are_many() const { return chords_.size() > many_chords_; }
  /// Are there many more chords than were left last time?
  bool needs_room() const { return are_too_many() || chords_.size() > most_chords_; }
  /// Drops chords that no piece holds, except where pieces were cut off; and where even so they are nearly too many,
  /// the shortest pieces. Then trajectories have other numbers and chords other places; the order of pieces stays.
  void make_room();
  /// Takes all pieces out.
  std::vector<Piece> take_pieces();

 private:
  double key(const Piece& piece, double length) const { return std::min(key(length, piece.trajectory()), piece.key); }
  bool comes_first(double key) const { return heap_.empty() || key >= heap_.front().key; }
  /// What was left off may be longer.
  bool is_long_enough(const Stretch& stretch, double length, std::int32_t trajectory) const {
    return length >= minimum_length_ || trajectories_[trajectory].is_left_off_at(stretch);
  }
  void insert(const Piece& piece, double length);
  void prefetch_next() const;
  double key(double length, std::int32_t trajectory) const {
    const auto& whole = trajectories_[trajectory];
    return length * (whole.is_closed() ? bonus_.closed : 1) * (whole.hugs ? bonus_.hugging : 1);
  }
  void drop_shortest();
  void drop_dead_chords();

  double minimum_length_;
  Bonus bonus_;
  Chords chords_;
  std::vector<Trajectory> trajectories_;
  std::vector<Piece> heap_;
  std::size_t most_chords_, many_chords_, too_many_chords_;
};

}  // namespace pectinate::detail
