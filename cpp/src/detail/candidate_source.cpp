// SPDX-License-Identifier: MIT
#include "detail/candidate_source.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace pectinate::detail {
namespace {

/// Beside streamlines this long, in chords, a candidate that hugs them makes others needless that would start in the
/// next ring of triangles; beside those twice as long, in the next two, where these do not reach to the line's other
/// side. They are the first ones of smooth fields: hundreds of candidates beside each, nearly as long and hardly apart,
/// would take most of the time.
constexpr std::size_t long_to_hug = 512;
constexpr int most_hugging_rings = 2;
/// Seeds of hugging lines lie this far outside the band that they hug, in separation distances.
constexpr double hugging_gap = 1e-6;
/// Rings of triangles beside a trajectory of the pool that need no other. The fewer lines there will be, the more it
/// pays to choose them well: beyond so many edges a separation distance the pool is denser; then triangles are small
/// beside d_sep, and a ring more of them beside a hugging candidate needs no other. Where streamlines need more room to
/// start than to go on, no triangle is left out.
constexpr int usual_rings = 2, rings_of_dense_pool = 1;
constexpr double sparse_separation = 6;

/// Of equilateral triangles that take as much area.
double mean_edge_length(const SurfaceMesh& mesh) {
  return std::sqrt(4 / std::numbers::sqrt3 * mesh.area() / static_cast<double>(mesh.triangle_count()));
}

}  // namespace

CandidateSource::CandidateSource(const SurfaceMesh& mesh, const StreamlineTracer& tracer, const LineRules& rules,
                                 const ChordOccupancy& occupancy, Candidates& candidates)
    : mean_edge_length_(mean_edge_length(mesh)),
      sheet_(tracer.sheet()),
      crossings_(sheet_.crossings),
      occupancy_(occupancy),
      candidates_(candidates),
      tracer_(tracer, occupancy, rules, candidates),
      served_(crossings_.size()) {}

bool CandidateSource::fill_pool(const std::function<bool()>& go_on) {
  const bool is_local = occupancy_.has_seed_sets();
  TriangleMarks has_been_crossed(is_local ? 0 : crossings_.size());
  std::vector<std::int32_t> seeds;  // the last one is the next
  served_.clear();
  for (const auto first : sheet_.ranks) {  // in the mesh's order: the sheet's depends on the axes
    if (served_.has(first)) continue;
    for (seeds.push_back(first); !seeds.empty();) {
      const auto t = seeds.back();
      seeds.pop_back();
      if (served_.has(t) || occupancy_.stopped().is_full(t)) continue;
      if (!go_on()) return false;
      const auto stretch = tracer_.add({t, 0.5}, {.served = &served_}, false).stretch();
      if (is_local) {
        serve(stretch);
        push_beside(stretch, seeds);  // on from there: its memory is at hand
      } else {
        serve_around(stretch, is_sparse(t) ? rings_of_dense_pool : usual_rings, has_been_crossed);
      }
    }
  }
  return true;
}

/// Is d_sep so many edges that there will be few streamlines?
bool CandidateSource::is_sparse(std::int32_t triangle) const {
  return separation(triangle) > sparse_separation * mean_edge_length_;
}

/// The triangles that a candidate crosses need no other.
void CandidateSource::serve(const Stretch& candidate) {
  for (const auto& chord : candidates_.chords_of(candidate)) served_.add(chord.triangle());
}

/// Nor do those so many triangles away.
void CandidateSource::serve_around(const Stretch& candidate, int rings, TriangleMarks& has_been_crossed) {
  std::vector<std::int32_t> crossed;
  for (const auto& chord : candidates_.chords_of(candidate)) {
    if (has_been_crossed.has(chord.triangle())) continue;  // all around it is served
    has_been_crossed.add(chord.triangle());
    crossed.push_back(chord.triangle());
  }
  mark_rings(crossings_, std::move(crossed), rings, served_);
}

/// Those beside a trajectory that are not served.
void CandidateSource::push_beside(const Stretch& stretch, std::vector<std::int32_t>& triangles) const {
  for (const auto& chord : candidates_.chords_of(stretch)) {
    for (const auto other : crossings_[chord.triangle()].neighbours) {
      if (other >= 0 && !served_.has(other)) triangles.push_back(other);
    }
  }
}

void CandidateSource::add_hugging(const Polyline& line, const std::vector<std::int32_t>& changed,
                                  const std::function<void()>& make_room) {
  served_.clear();
  const int rings = rings_beside_hugging(line);
  for (const auto t : changed) {
    if (occupancy_.unseeded().is_full(t) || is_served_near(t, rings)) continue;
    make_room();  // what goes for want of it comes back when gaps are filled
    add_hugging(t);
  }
}

/// Just outside what is occupied of a triangle.
void CandidateSource::add_hugging(std::int32_t triangle) {
  const double gap = hugging_gap * separation(triangle) / crossings_[triangle].width;
  occupancy_.unseeded().get_intervals(triangle, intervals_);
  for (const auto& [low, high] : intervals_) {
    for (const double coordinate : {low - gap, high + gap}) {
      if (!(coordinate > least_position && coordinate < 1 - least_position)) continue;
      if (occupancy_.unseeded().contains(triangle, coordinate)) continue;
      serve(tracer_.add({triangle, coordinate}, {.others = true}, true).stretch());
    }
  }
}

/// Beside a streamline; not so many that they reach across its band.
int CandidateSource::rings_beside_hugging(const Polyline& line) const {
  const auto first = line.triangles.front();
  const auto wanted = static_cast<int>(std::bit_width(line.triangles.size() / long_to_hug)) +
                      static_cast<int>(is_sparse(first) && !occupancy_.has_seed_sets());
  const double across = 2 * separation(first) / mean_edge_length_ - 1;
  return static_cast<int>(std::clamp(across, 0.0, static_cast<double>(std::min(wanted, most_hugging_rings))));
}

/// Is the triangle served, or another so many rings around it?
bool CandidateSource::is_served_near(std::int32_t triangle, int rings) const {
  if (served_.has(triangle)) return true;
  return rings > 0 && std::ranges::any_of(crossings_[triangle].neighbours, [&](std::int32_t beside) {
           return beside >= 0 && is_served_near(beside, rings - 1);
         });
}

void CandidateSource::add_in_gaps(const std::vector<std::int32_t>& triangles,
                                  const std::function<double(const Interval&)>& start_in) {
  served_.clear();
  for (const auto t : triangles) {
    if (served_.has(t) || occupancy_.unseeded().is_full(t)) continue;
    for (const auto& gap : occupancy_.unseeded().gaps(t)) {
      if (gap.high - gap.low < least_gap) continue;
      const ChordPlace start{t, start_in(gap)};
      if (is_free(start)) serve(add(start));
    }
  }
}

}  // namespace pectinate::detail
