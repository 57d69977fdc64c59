// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "detail/capsule.hpp"
#include "detail/chord_shadow.hpp"
#include "detail/sheet.hpp"

namespace pectinate::detail {

/// Tells which chords capsules take of triangles, one after the other. Questions wait until there are as many as are
/// answered together; what is asked for must stay where it is until then.
class CapsuleMarks {
 public:
  /// Which chords a capsule takes: those that enter it, or those that lie in it with all their length.
  enum class Kind : std::uint8_t { shadows, cores };
  using Take = std::function<void(std::int32_t triangle, const Interval& chords)>;

  struct Question {
    std::int32_t triangle;  ///< of the sheet
    const Vector &start, &end;
    double radius;
    double margin;  ///< chords of a shadow are widened by so much; a distance
  };

  /// Calls `take` for the chords of each triangle, as few and as long intervals as follow from their order.
  CapsuleMarks(const Sheet& sheet, Kind kind, Take take) : sheet_(sheet), kind_(kind), take_(std::move(take)) {}

  void ask(const Question& question);
  /// All that was asked for is taken.
  void finish();

 private:
  void answer();
  void fill_up();
  void join(std::int32_t triangle, const Interval& chords);
  void take_joined();

  const Sheet& sheet_;
  Kind kind_;
  Take take_;
  ShadowQuestions questions_;
  std::array<std::int32_t, shadow_lanes> triangles_;
  std::array<double, shadow_lanes> margins_;
  std::size_t count_ = 0;
  std::int32_t joined_triangle_ = -1;  // none
  Interval joined_{};                  // chords of that triangle, not yet taken
};

}  // namespace pectinate::detail
