// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <vector>

#include "detail/chord_occupancy.hpp"
#include "detail/edge_point.hpp"
#include "detail/seed_regions.hpp"
#include "detail/sheet.hpp"
#include "pectinate/occupancy.hpp"

namespace pectinate {
namespace {

/// Areas become whole numbers for exact drawing: the mean area is this much.
constexpr double weight_of_mean_area = 65536;
/// Half the share of a triangle that a useless seed takes with it.
constexpr double retired_half_width = 1.0 / 128;

/// The exact occupancy with seeds to draw, for the paper's placement methods.
class ExactOccupancy final : public Occupancy {
 public:
  ExactOccupancy(const SurfaceMesh& mesh, const StreamlineTracer& tracer, const Clearance& clearance,
                 const SingularRegion& singular)
      : mesh_(mesh),
        sheet_(tracer.sheet()),
        occupancy_(mesh, tracer, clearance, singular),
        free_(mesh.triangle_count()) {
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(mesh.triangle_count()); ++t) update(t);
  }

  bool admits(std::int32_t triangle, double chord, const EdgePoint&) const override {
    return !occupancy_.stopped().contains(sheet_.ranks[triangle], chord);
  }

  StopReason stop_reason(std::int32_t triangle, double chord) const override {
    return occupancy_.stop_reason(sheet_.ranks[triangle], chord);
  }

  bool admits_seed(const Seed& seed) const override {
    return !occupancy_.unseeded().contains(sheet_.ranks[seed.triangle], chord_of(seed));
  }

  void add(const Streamline& streamline) override {
    detail::Polyline line;
    for (const auto& point : streamline.points) line.points.push_back(detail::position(mesh_, point));
    for (std::size_t i = 0; i < streamline.triangles.size(); ++i) {
      line.triangles.push_back(sheet_.ranks[streamline.triangles[i]]);
      line.chords.push_back(chord_of({streamline.points[i], streamline.triangles[i]}));
    }
    occupancy_.add(line);
    for (const auto triangle : occupancy_.changed()) update(sheet_.mesh_triangle(triangle));
  }

  void retire_seed(const Seed& seed) override {
    const double chord = chord_of(seed);
    occupancy_.retire_seed(sheet_.ranks[seed.triangle], {chord - retired_half_width, chord + retired_half_width});
    update(seed.triangle);
  }

  std::optional<Seed> draw_seed(SeedRegion region, Random& random) const override {
    const auto triangle = free_.draw(region, random);
    if (!triangle) return std::nullopt;
    return seed_on(*triangle, draw_chord(*triangle, random));
  }

  double coverage() const override { return occupancy_.coverage(); }

 private:
  const detail::TriangleCrossings& crossings_of(std::int32_t triangle) const {
    return sheet_.crossings[sheet_.ranks[triangle]];
  }

  double chord_of(const Seed& seed) const {
    const auto& crossings = crossings_of(seed.triangle);
    return detail::chord_coordinate(crossings, detail::role_with_edge(mesh_, seed.triangle, crossings, seed.point.edge),
                                    seed.point.position);
  }

  Seed seed_on(std::int32_t triangle, double chord) const {
    const auto& crossings = crossings_of(triangle);
    return {detail::edge_point(mesh_, triangle, crossings, detail::low_high, chord), triangle};
  }

  double draw_chord(std::int32_t triangle, Random& random) const {
    const auto gaps = occupancy_.unseeded().gaps(sheet_.ranks[triangle]);
    double width = 0;
    for (const auto& gap : gaps) width += gap.high - gap.low;
    double offset = random.unit() * width;
    for (const auto& gap : gaps) {
      if (offset < gap.high - gap.low) return gap.low + offset;
      offset -= gap.high - gap.low;
    }
    return (gaps.back().low + gaps.back().high) / 2;
  }

  void update(std::int32_t triangle) {
    const auto rank = sheet_.ranks[triangle];
    const double scale = weight_of_mean_area * static_cast<double>(mesh_.triangle_count()) / mesh_.area();
    const double free_area = occupancy_.free_share(rank) * mesh_.triangle_areas()[triangle];
    const bool full = occupancy_.unseeded().is_full(rank);
    const auto weight = full ? 0 : std::max<std::uint64_t>(1, std::llround(free_area * scale));
    free_.set(triangle, weight, occupancy_.unseeded().is_empty(rank));
  }

  const SurfaceMesh& mesh_;
  const detail::Sheet& sheet_;
  detail::ChordOccupancy occupancy_;
  detail::SeedRegions free_;
};

}  // namespace

std::unique_ptr<Occupancy> make_exact_occupancy(const SurfaceMesh& mesh, const StreamlineTracer& tracer,
                                                const Clearance& clearance, const SingularRegion& singular) {
  return std::make_unique<ExactOccupancy>(mesh, tracer, clearance, singular);
}

}  // namespace pectinate
