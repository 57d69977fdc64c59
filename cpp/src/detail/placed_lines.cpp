// SPDX-License-Identifier: MIT
#include "detail/placed_lines.hpp"

#include <optional>

#include "detail/chord_sides.hpp"
#include "detail/vec.hpp"

namespace pectinate::detail {
namespace {

/// The chord that follows on one across the side through which that leaves.
std::optional<Chord> chord_ahead(const Sheet& sheet, const Chord& chord) {
  const Role exit = exit_side(sheet, chord);
  const auto way_out = sheet.crossings[chord.triangle()].exit(exit);
  if (way_out.triangle < 0) return std::nullopt;
  const auto& crossings = sheet.crossings[way_out.triangle];
  const double position = edge_position(sheet.crossings[chord.triangle()], exit, chord.coordinate);
  const double coordinate = chord_coordinate(crossings, way_out.role, position);
  return make_chord(sheet, {way_out.triangle, coordinate}, exit_role(crossings, way_out.role, coordinate) == low_high);
}

/// How long a way is, point by point.
class WayLength {
 public:
  void pass(const Vector& point) {
    if (last_) length_ += (point - *last_).norm();
    last_ = point;
  }
  double length() const { return length_; }

 private:
  std::optional<Vector> last_;
  double length_ = 0;
};

}  // namespace

ChordsAhead chords_ahead(const Sheet& sheet, const PlacedLine& line) {
  Chord outwards[] = {line.chords.front(), line.chords.back()};
  outwards[0].code ^= 1;
  ChordsAhead ahead;
  for (const int end : {0, 1}) {
    const auto reason = line.stop_reasons[end];
    if (reason == StopReason::near_other || (reason == StopReason::near_itself && line.is_cut[end])) {
      ahead[end] = chord_ahead(sheet, outwards[end]);
    }
  }
  return ahead;
}

void reserve(std::size_t point_count, Placement& placement) {
  placement.points.reserve(point_count);
  placement.barycentric.reserve(point_count);
  placement.point_triangles.reserve(point_count);
  placement.segment_triangles.reserve(point_count);
}

double length_of(const Sheet& sheet, const PlacedLine& line) {
  WayLength way;
  visit_points(sheet, line.chords, line.is_closed, [&](const Vector& point) { way.pass(point); });
  return way.length();
}

void PlacedLines::add(const PlacedLine& line) {
  const auto count = static_cast<std::int32_t>(line.chords.size());
  lines_.push_back({std::ssize(chords_), count, line.is_closed, line.stop_reasons, line.is_cut});
  chords_.insert(chords_.end(), line.chords.begin(), line.chords.end());
}

PlacedLine PlacedLines::operator[](std::size_t line) const {
  const auto& [first, count, is_closed, stop_reasons, is_cut] = lines_[line];
  return {std::span(chords_).subspan(first, count), is_closed, stop_reasons, is_cut};
}

void PlacedLines::write(const Sheet& sheet, Placement& placement) const {
  reserve(chords_.size() + 3 * count(), placement);
  for (std::size_t line = 0; line < count(); ++line) write(sheet, (*this)[line], placement);
}

void PlacedLines::write(const Sheet& sheet, const PlacedLine& line, Placement& placement) const {
  const auto first = std::ssize(placement.points);
  WayLength way;
  visit_points(sheet, line.chords, line.is_closed, [&](const Vector& point) {
    placement.points.push_back(vec3(point));
    way.pass(point);
  });
  visit_weights(sheet, line.chords, line.is_closed,
                [&](const Vec3& weights) { placement.barycentric.push_back(weights); });
  for (const auto& chord : line.chords) {
    const auto triangle = sheet.mesh_triangle(chord.triangle());
    placement.segment_triangles.push_back(triangle);
    placement.point_triangles.push_back(triangle);
  }
  placement.point_triangles.push_back(placement.segment_triangles.back());
  placement.offsets.push_back(std::ssize(placement.points));
  placement.lengths.push_back(way.length());
  placement.stop_reasons.push_back(line.stop_reasons);
  placement.seed_points.push_back((first + std::ssize(placement.points)) / 2);
}

}  // namespace pectinate::detail
