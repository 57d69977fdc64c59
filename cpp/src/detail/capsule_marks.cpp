// SPDX-License-Identifier: MIT
#include "detail/capsule_marks.hpp"

#include <algorithm>

namespace pectinate::detail {

void CapsuleMarks::ask(const Question& question) {
  const auto lane = count_++;
  const auto triangle = question.triangle;
  questions_.low[lane] = &sheet_.low(triangle);
  questions_.middle[lane] = &sheet_.middle(triangle);
  questions_.high[lane] = &sheet_.high(triangle);
  questions_.split[lane] = sheet_.crossings[triangle].split;
  questions_.start[lane] = &question.start;
  questions_.end[lane] = &question.end;
  questions_.radius[lane] = question.radius;
  triangles_[lane] = triangle;
  margins_[lane] = question.margin;
  if (count_ == shadow_lanes) answer();
}

void CapsuleMarks::finish() {
  if (count_ > 0) answer();
  take_joined();
}

void CapsuleMarks::answer() {
  fill_up();
  if (kind_ == Kind::cores) {
    const auto parts = chord_cores(questions_);
    for (std::size_t lane = 0; lane < count_; ++lane) {
      for (const auto& part : parts) join(triangles_[lane], {part.low[lane], part.high[lane]});
    }
  } else {
    const auto [chords, width] = chord_shadows(questions_);
    for (std::size_t lane = 0; lane < count_; ++lane) {
      if (!(chords.low[lane] <= chords.high[lane])) continue;
      const double margin = margins_[lane] / width[lane];
      join(triangles_[lane], {chords.low[lane] - margin, chords.high[lane] + margin});
    }
  }
  count_ = 0;
}

/// With the last question, again and again.
void CapsuleMarks::fill_up() {
  auto& [low, middle, high, split, start, end, radius] = questions_;
  for (auto lane = count_; lane < shadow_lanes; ++lane) {
    for (auto* places : {&low, &middle, &high, &start, &end}) (*places)[lane] = (*places)[lane - 1];
    for (auto* numbers : {&split, &radius}) (*numbers)[lane] = (*numbers)[lane - 1];
  }
}

/// Joins chords to those at hand while they overlap, as most do.
void CapsuleMarks::join(std::int32_t triangle, const Interval& chords) {
  if (!(chords.low <= chords.high)) return;
  if (triangle == joined_triangle_ && chords.low <= joined_.high && chords.high >= joined_.low) {
    joined_ = {std::min(joined_.low, chords.low), std::max(joined_.high, chords.high)};
  } else {
    take_joined();
    joined_triangle_ = triangle;
    joined_ = chords;
  }
}

void CapsuleMarks::take_joined() {
  if (joined_triangle_ >= 0) take_(joined_triangle_, joined_);
  joined_triangle_ = -1;
}

}  // namespace pectinate::detail
