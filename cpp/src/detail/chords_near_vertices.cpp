// SPDX-License-Identifier: MIT
#include "detail/chords_near_vertices.hpp"

#include <optional>

#include "detail/capsule.hpp"
#include "detail/chord_shadow.hpp"
#include "detail/vec.hpp"

namespace pectinate::detail {
namespace {

/// Searches the triangles around one vertex after the other.
class VertexSearch {
 public:
  VertexSearch(const SurfaceMesh& mesh, const Sheet& sheet, double radius)
      : mesh_(mesh), sheet_(sheet), radius_(radius), round_of_(mesh.triangle_count(), 0) {}

  void add_around(const Vector& vertex, std::int32_t start, std::vector<ChordRange>& found) {
    ++round_;
    queue_.clear();
    reach(start);
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      const auto t = queue_[i];
      const auto rank = sheet_.ranks[t];
      if (sheet_.has_direction(rank)) {
        const auto chords = chords_near(rank, vertex);
        if (!chords) continue;
        found.push_back({rank, *chords});
      } else if (!is_near(rank, vertex)) {
        continue;
      }
      for (const auto edge : mesh_.triangle_edges()[t]) {
        for (const auto next : mesh_.edge_triangles(edge)) reach(next);
      }
    }
  }

 private:
  void reach(std::int32_t t) {
    if (round_of_[t] == round_) return;
    round_of_[t] = round_;
    queue_.push_back(t);
  }

  std::optional<Interval> chords_near(std::int32_t rank, const Vector& vertex) const {
    ShadowQuestions questions;
    questions.low.fill(&sheet_.low(rank));
    questions.middle.fill(&sheet_.middle(rank));
    questions.high.fill(&sheet_.high(rank));
    questions.split.fill(sheet_.crossings[rank].split);
    questions.start.fill(&vertex);
    questions.end.fill(&vertex);
    questions.radius.fill(radius_ * (1 + guard));
    const auto [chords, width] = chord_shadows(questions);
    if (!(chords.low[0] <= chords.high[0])) return std::nullopt;
    const double margin = guard * radius_ / width[0];
    return Interval{chords.low[0] - margin, chords.high[0] + margin};
  }

  /// Of a triangle without chords.
  bool is_near(std::int32_t rank, const Vector& vertex) const {
    const Capsule ball{vertex, vertex, radius_};
    const Vector &a = sheet_.low(rank), &b = sheet_.middle(rank), &c = sheet_.high(rank);
    return intersect(ball, a, b - a) || intersect(ball, b, c - b) || intersect(ball, c, a - c);
  }

  const SurfaceMesh& mesh_;
  const Sheet& sheet_;
  double radius_;
  std::vector<std::uint32_t> round_of_;  // per mesh triangle: in which it was reached last
  std::uint32_t round_ = 0;
  std::vector<std::int32_t> queue_;
};

}  // namespace

std::vector<ChordRange> chords_near_vertices(const SurfaceMesh& mesh, const Sheet& sheet,
                                             const std::vector<std::int32_t>& vertices, double radius) {
  std::vector<std::int32_t> triangle_at(mesh.vertices().size(), -1);
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) {
    for (const auto v : mesh.triangles()[t]) triangle_at[v] = t;
  }
  VertexSearch search(mesh, sheet, radius);
  std::vector<ChordRange> found;
  for (const auto v : vertices) search.add_around(vector(mesh.vertices()[v]), triangle_at[v], found);
  return found;
}

}  // namespace pectinate::detail
