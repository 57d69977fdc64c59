// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "detail/placed_lines.hpp"
#include "detail/sheet.hpp"

namespace pectinate::detail {

/// A line that can be taken out and put back.
struct HeldLine {
  std::vector<Chord> chords;
  bool is_closed = false;
  std::array<StopReason, 2> stop_reasons{};
  std::array<bool, 2> is_cut{};  ///< as of the placed line
  double length = 0;
  std::int64_t rank = 0;  ///< how many lines were placed before
  /// The chords that would follow at its ends if no other line were near: only where one is.
  std::array<std::optional<ChordPlace>, 2> beyond;
};

/// Lines by number: those that lie on the surface, and those that were taken out and may come back.
class HeldLines {
 public:
  explicit HeldLines(const Sheet& sheet) : sheet_(sheet), ends_(sheet.crossings.size()) {}

  const HeldLine& operator[](std::int32_t line) const { return lines_[line]; }
  bool is_out(std::int32_t line) const { return positions_[line] < 0; }
  /// The numbers of those that lie on the surface.
  const std::vector<std::int32_t>& present() const { return present_; }
  /// Of those, the lines of which an end would go on into a triangle if no other line were near; some twice.
  std::span<const std::int32_t> ending_before(std::int32_t triangle) const { return ends_[triangle]; }

  /// A number that is not in use.
  std::int32_t new_number();
  /// Puts a new line on the surface.
  void place(std::int32_t line, const PlacedLine& placed);
  PlacedLine placed(std::int32_t line) const {
    const auto& held = lines_[line];
    return {held.chords, held.is_closed, held.stop_reasons, held.is_cut};
  }
  void take_out(std::int32_t line);
  void put_back(std::int32_t line);
  /// Gives up a line that was taken out.
  void forget(std::int32_t line) { unused_.push_back(line); }

 private:
  const Sheet& sheet_;
  std::int64_t placed_count_ = 0;
  std::vector<HeldLine> lines_;
  std::vector<std::int32_t> positions_;  // per line: where it is among those present; negative: out
  std::vector<std::int32_t> present_, unused_;
  std::vector<std::vector<std::int32_t>> ends_;  // per triangle
};

}  // namespace pectinate::detail
