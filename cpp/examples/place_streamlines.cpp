// SPDX-License-Identifier: MIT
// A solver that embeds the engine: a surface, its fibres, evenly spaced streamlines, their statistics.
#include <cstdio>
#include <cstdlib>
#include <pectinate/pectinate.hpp>

namespace {

void print(const pectinate::SurfaceMesh& mesh, const pectinate::Placement& placement) {
  const pectinate::PlacementStatistics& statistics = placement.statistics;
  std::printf("triangles       %zu\n", mesh.triangle_count());
  std::printf("surface area    %.1f mm2\n", statistics.surface_area);
  std::printf("streamlines     %lld\n", static_cast<long long>(statistics.streamline_count));
  std::printf("mean length     %.2f mm\n", statistics.mean_length);
  std::printf("mean spacing    %.3f mm, %.3f separation distances\n", statistics.mean_spacing,
              statistics.mean_spacing_ratio);
  std::printf("coverage        %.4f\n", statistics.coverage);
}

}  // namespace

int main() {
  try {
    const pectinate::DemoAtrium atrium = pectinate::make_demo_atrium({.edge_length = 2.0});
    const pectinate::SurfaceMesh mesh(atrium.vertices, atrium.triangles);
    const auto field = pectinate::OrientationField::from_triangle_vectors(mesh, atrium.directions);

    pectinate::PlacementOptions options;
    options.separation_distance = 3.2;
    const pectinate::Placement placement = pectinate::place_streamlines(mesh, field, options);

    print(mesh, placement);
    return placement.end == pectinate::PlacementEnd::complete ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const pectinate::Error& error) {
    std::fprintf(stderr, "place_streamlines: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
