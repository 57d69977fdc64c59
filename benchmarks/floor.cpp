// SPDX-License-Identifier: MIT
// The physical floor of a placement: how long it takes to trace the streamlines that it kept, once, and nothing else.
//   floor SURFACE.bin D_SEP REPEATS
// SURFACE.bin: int64 vertex and triangle counts, vertices and vectors per triangle as float64, triangles as int32.
// Prints one JSON object; seconds of CPU, the best of the repeats.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "detail/crossings.hpp"
#include "detail/sheet.hpp"
#include "pectinate/pectinate.hpp"

namespace {

using pectinate::Placement;
using pectinate::SurfaceMesh;
using pectinate::Vec3;
using pectinate::detail::Role;
using pectinate::detail::Sheet;
using pectinate::detail::Vector;

struct Surface {
  std::vector<Vec3> vertices, vectors;
  std::vector<pectinate::Triangle> triangles;
};

template <class Item>
std::vector<Item> read_items(std::ifstream& file, std::int64_t count) {
  std::vector<Item> items(count);
  file.read(reinterpret_cast<char*>(items.data()), static_cast<std::streamsize>(count * sizeof(Item)));
  return items;
}

Surface read_surface(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const auto counts = read_items<std::int64_t>(file, 2);
  Surface surface;
  surface.vertices = read_items<Vec3>(file, counts[0]);
  surface.vectors = read_items<Vec3>(file, counts[1]);
  surface.triangles = read_items<pectinate::Triangle>(file, counts[1]);
  if (!file) throw std::runtime_error("cannot read " + path);
  return surface;
}

double cpu_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Work>
double best_seconds(int repeats, const Work& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repeats; ++i) {
    const double start = cpu_seconds();
    work();
    best = std::min(best, cpu_seconds() - start);
  }
  return best;
}

/// Ends where another streamline is near lie in the midst of triangles: up to there it is not traced.
bool lies_on_side(const Placement& placement, std::int64_t point) {
  return *std::ranges::min_element(placement.barycentric[point]) == 0;
}

/// Where a kept streamline begins, and how far it goes.
struct Start {
  std::int32_t triangle;
  Role entry;
  double chord;
  std::int64_t segments;
};

std::vector<Start> starts_of(const SurfaceMesh& mesh, const Sheet& sheet, const Placement& placement) {
  std::vector<Start> starts;
  for (std::size_t i = 0; i + 1 < placement.offsets.size(); ++i) {
    const auto point = placement.offsets[i] + !lies_on_side(placement, placement.offsets[i]);
    const auto last = placement.offsets[i + 1] - 1 - !lies_on_side(placement, placement.offsets[i + 1] - 1);
    const auto mesh_triangle = placement.segment_triangles[point - static_cast<std::int64_t>(i)];
    const auto& weights = placement.barycentric[point];
    const auto triangle = sheet.ranks[mesh_triangle];
    const auto& crossings = sheet.crossings[triangle];
    const auto across = static_cast<int>(std::min_element(weights.begin(), weights.end()) - weights.begin());
    const int side = (across + 1) % 3;
    const double along = weights[mesh.runs_along(mesh_triangle, side) ? (side + 1) % 3 : side];
    const Role entry = pectinate::detail::role_of(side, crossings.middle);
    starts.push_back({triangle, entry, chord_coordinate(crossings, entry, along), last - point});
  }
  return starts;
}

/// Traces every streamline from its first point to its last, and writes its points.
void trace(const Sheet& sheet, const std::vector<Start>& starts, std::vector<Vector>& points) {
  points.clear();
  for (auto [triangle, entry, chord, segments] : starts) {
    points.push_back(sheet.point(triangle, entry, chord));
    for (; segments > 0; --segments) {
      const auto& crossings = sheet.crossings[triangle];
      const Role role = exit_role(crossings, entry, chord);
      points.push_back(sheet.point(triangle, role, chord));
      if (segments == 1) break;
      const double position = edge_position(crossings, role, chord);
      const auto exit = crossings.exit(role);
      triangle = exit.triangle;
      entry = exit.role;
      chord = chord_coordinate(sheet.crossings[triangle], entry, position);
    }
  }
}

double greatest_difference(const Placement& placement, const std::vector<Vector>& points) {
  double greatest = 0;
  auto traced = points.begin();
  for (std::int64_t i = 0; i < std::ssize(placement.points); ++i) {
    if (!lies_on_side(placement, i)) continue;
    if (traced == points.end()) return std::numeric_limits<double>::infinity();
    const Vector kept(placement.points[i][0], placement.points[i][1], placement.points[i][2]);
    greatest = std::max(greatest, (*traced++ - kept).norm());
  }
  return traced == points.end() ? greatest : std::numeric_limits<double>::infinity();
}

void measure(const std::string& path, double separation, int repeats) {
  const Surface surface = read_surface(path);
  const SurfaceMesh mesh(surface.vertices, surface.triangles);
  const auto field = pectinate::OrientationField::from_triangle_vectors(mesh, surface.vectors);
  pectinate::PlacementOptions options;
  options.separation_distance = separation;
  Placement placement;
  const double placing = best_seconds(repeats, [&] { placement = place_streamlines(mesh, field, options); });

  pectinate::TracingOptions tracing;
  tracing.separation_distance = separation;
  const double preparing =
      best_seconds(repeats, [&] { const pectinate::StreamlineTracer another(mesh, field, tracing); });
  const pectinate::StreamlineTracer tracer(mesh, field, tracing);
  const auto starts = starts_of(mesh, tracer.sheet(), placement);
  std::vector<Vector> points;
  points.reserve(placement.points.size());
  const double tracing_once = best_seconds(repeats, [&] { trace(tracer.sheet(), starts, points); });
  std::printf(
      "{\"placing\": %.9g, \"preparing\": %.9g, \"tracing\": %.9g, \"segments\": %zu, \"streamlines\": %zu, "
      "\"greatest_difference\": %.3g}\n",
      placing, preparing, tracing_once, points.size() - starts.size(), starts.size(),
      greatest_difference(placement, points));
}

}  // namespace

int main(int count, char** arguments) {
  try {
    if (count != 4) throw std::runtime_error("usage: floor SURFACE.bin D_SEP REPEATS");
    measure(arguments[1], std::stod(arguments[2]), std::stoi(arguments[3]));
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "floor: %s\n", error.what());
    return EXIT_FAILURE;
  }
}
