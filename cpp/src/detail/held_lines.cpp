// SPDX-License-Identifier: MIT
#include "detail/held_lines.hpp"

namespace pectinate::detail {

std::int32_t HeldLines::new_number() {
  if (unused_.empty()) {
    unused_.push_back(static_cast<std::int32_t>(lines_.size()));
    lines_.emplace_back();
    positions_.push_back(-1);
  }
  const auto line = unused_.back();
  unused_.pop_back();
  return line;
}

void HeldLines::place(std::int32_t line, const PlacedLine& placed) {
  auto& held = lines_[line];
  held.chords.assign(placed.chords.begin(), placed.chords.end());
  held.is_closed = placed.is_closed;
  held.stop_reasons = placed.stop_reasons;
  held.is_cut = placed.is_cut;
  held.length = length_of(sheet_, placed);
  held.rank = placed_count_++;
  held.beyond = {};
  const auto ahead = chords_ahead(sheet_, placed);
  for (const int end : {0, 1}) {
    if (placed.stop_reasons[end] != StopReason::near_other) continue;
    if (const auto& chord = ahead[end]) held.beyond[end] = {chord->triangle(), chord->coordinate};
  }
  put_back(line);
}

void HeldLines::put_back(std::int32_t line) {
  positions_[line] = static_cast<std::int32_t>(present_.size());
  present_.push_back(line);
  for (const auto& beyond : lines_[line].beyond) {
    if (beyond) ends_[beyond->triangle].push_back(line);
  }
}

void HeldLines::take_out(std::int32_t line) {
  const auto last = present_.back();
  present_[positions_[line]] = last;
  positions_[last] = positions_[line];
  present_.pop_back();
  positions_[line] = -1;
  for (const auto& beyond : lines_[line].beyond) {
    if (beyond) std::erase(ends_[beyond->triangle], line);
  }
}

}  // namespace pectinate::detail
