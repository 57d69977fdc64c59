// SPDX-License-Identifier: MIT
#include "pectinate/placement.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>

#include "detail/edge_point.hpp"
#include "detail/random.hpp"
#include "detail/seed_ring.hpp"
#include "detail/thread_pool.hpp"
#include "pectinate/errors.hpp"
#include "pectinate/occupancy.hpp"

namespace pectinate {
namespace {

using Clock = std::chrono::steady_clock;
using WorkspacePointer = decltype(StreamlineTracer::make_workspace());

constexpr auto progress_interval = std::chrono::milliseconds(50);
/// Candidates that a thread traces between two looks at the clock.
constexpr std::int64_t candidates_per_look = 8;

void check(const PlacementOptions& options) {
  if (options.seed_count < 1) {
    throw InvalidOption("seed_count is " + std::to_string(options.seed_count) + ", but must be at least 1");
  }
  if (!(options.seed_distance_factor >= 1 && options.seed_distance_factor < 1e6)) {
    throw InvalidOption("seed_distance_factor is " + std::to_string(options.seed_distance_factor) +
                        ", but must be at least 1 and finite: nearer than d_sep nothing is free");
  }
  if (options.thread_count < 1 || options.thread_count > 1024) {
    throw InvalidOption("thread_count is " + std::to_string(options.thread_count) + ", but must be in [1, 1024]");
  }
}

/// Asks the user's callback now and then whether to go on.
class Progress {
 public:
  explicit Progress(const std::function<bool(double)>& callback) : callback_(callback) {}

  bool is_cancelled(double coverage) {
    if (!callback_ || cancelled_ || Clock::now() - last_call_ < progress_interval) return cancelled_;
    last_call_ = Clock::now();
    return cancelled_ = !callback_(coverage);
  }

 private:
  const std::function<bool(double)>& callback_;
  Clock::time_point last_call_{};
  bool cancelled_ = false;
};

/// Draws the seed points of one step by the paper's three methods.
class SeedSource {
 public:
  SeedSource(const SurfaceMesh& mesh, const PlacementOptions& options)
      : method_(options.method), random_(options.random_seed) {
    if (method_ == PlacementMethod::distance) {
      ring_.emplace(mesh, options.seed_distance_factor * options.separation_distance);
    }
  }

  void add(const Streamline& streamline) {
    if (ring_) ring_->add(streamline);
  }

  /// Up to `count` points; fewer only if nothing is free.
  std::vector<EdgePoint> draw(const Occupancy& occupancy, int count) {
    std::vector<EdgePoint> seeds;
    seeds.reserve(count);
    for (int i = 0; i < count; ++i) {
      const auto seed = draw_one(occupancy);
      if (!seed) break;
      seeds.push_back(*seed);
    }
    return seeds;
  }

 private:
  std::optional<EdgePoint> draw_one(const Occupancy& occupancy) {
    std::optional<EdgePoint> seed;
    if (ring_) seed = ring_->draw(occupancy, random_);
    if (method_ == PlacementMethod::neighborhood) seed = occupancy.draw_seed(SeedRegion::partly_free, random_);
    if (!seed && method_ != PlacementMethod::random) seed = occupancy.draw_seed(SeedRegion::wholly_free, random_);
    return seed ? seed : occupancy.draw_seed(SeedRegion::free, random_);
  }

  PlacementMethod method_;
  Random random_;
  std::optional<detail::SeedRing> ring_;
};

/// Traces the candidates of one step and finds the longest; of equals, the first drawn.
class Contest {
 public:
  Contest(const StreamlineTracer& tracer, int thread_count)
      : tracer_(tracer), pool_(thread_count), desks_(pool_.thread_count()) {}

  struct Outcome {
    const Streamline* longest = nullptr;  // none if no candidate has a segment
    std::vector<EdgePoint> useless;       // seeds of candidates without one
  };

  /// None if it was cancelled.
  std::optional<Outcome> hold(const std::vector<EdgePoint>& seeds, const Occupancy& occupancy, Progress& progress) {
    for (auto& desk : desks_) desk.winner = none;
    lengths_.assign(seeds.size(), 0);
    const auto slice = candidates_per_look * pool_.thread_count();
    const auto count = static_cast<std::int64_t>(seeds.size());
    for (std::int64_t first = 0; first < count; first += slice) {
      if (progress.is_cancelled(occupancy.coverage())) return std::nullopt;
      pool_.run(std::min(slice, count - first), [&](std::int64_t index, int thread) {
        trace(first + index, seeds[first + index], occupancy, desks_[thread]);
      });
    }
    return judge(seeds);
  }

 private:
  static constexpr std::int64_t none = -1;

  /// One thread's place of work.
  struct Desk {
    WorkspacePointer best = StreamlineTracer::make_workspace(), current = StreamlineTracer::make_workspace();
    const Streamline* best_line = nullptr;
    std::int64_t winner = none;
  };

  void trace(std::int64_t index, const EdgePoint& seed, const Occupancy& occupancy, Desk& desk) {
    const auto& line = tracer_.trace(seed, &occupancy, *desk.current);
    lengths_[index] = line.triangles.empty() ? 0 : line.length;
    if (lengths_[index] > 0 && (desk.winner == none || lengths_[index] > lengths_[desk.winner])) {
      std::swap(desk.best, desk.current);
      desk.best_line = &line;
      desk.winner = index;
    }
  }

  Outcome judge(const std::vector<EdgePoint>& seeds) const {
    Outcome outcome;
    const auto winner = std::max_element(lengths_.begin(), lengths_.end()) - lengths_.begin();
    for (const auto& desk : desks_) {
      if (desk.winner == winner) outcome.longest = desk.best_line;
    }
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      if (lengths_[i] == 0) outcome.useless.push_back(seeds[i]);
    }
    return outcome;
  }

  const StreamlineTracer& tracer_;
  detail::ThreadPool pool_;
  std::vector<Desk> desks_;
  std::vector<double> lengths_;
};

/// Weights of a triangle's corners at a point on one of its sides.
Vec3 barycentric_on_side(const SurfaceMesh& mesh, std::int32_t t, const EdgePoint& point) {
  Vec3 weights{0, 0, 0};
  for (int side = 0; side < 3; ++side) {
    if (mesh.triangle_edges()[t][side] != point.edge) continue;
    const int first = mesh.runs_along(t, side) ? side : (side + 1) % 3;
    const int second = mesh.runs_along(t, side) ? (side + 1) % 3 : side;
    weights[first] = 1 - point.position;
    weights[second] = point.position;
  }
  return weights;
}

void append(const SurfaceMesh& mesh, const Streamline& line, Placement& placement) {
  const auto first = static_cast<std::int64_t>(placement.points.size());
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const auto triangle = line.triangles[std::min(i, line.triangles.size() - 1)];
    placement.points.push_back(detail::vec3(detail::position(mesh, line.points[i])));
    placement.point_triangles.push_back(triangle);
    placement.barycentric.push_back(barycentric_on_side(mesh, triangle, line.points[i]));
  }
  placement.segment_triangles.insert(placement.segment_triangles.end(), line.triangles.begin(), line.triangles.end());
  placement.offsets.push_back(static_cast<std::int64_t>(placement.points.size()));
  placement.lengths.push_back(line.length);
  placement.stop_reasons.push_back(line.stop_reasons);
  placement.seed_points.push_back(first + line.seed_index);
}

double directed_area(const SurfaceMesh& mesh, const OrientationField& field) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    if (field.has_direction(static_cast<std::int32_t>(t))) area += mesh.triangle_areas()[t];
  }
  return area;
}

}  // namespace

Placement place_streamlines(const SurfaceMesh& mesh, const OrientationField& field, const PlacementOptions& options) {
  check(options);
  const StreamlineTracer tracer(mesh, field,
                                {options.separation_distance, options.abrupt_turn_angle, options.max_steps});
  const auto occupancy = make_edge_mask(mesh, tracer);
  SeedSource source(mesh, options);
  Contest contest(tracer, options.thread_count);
  Progress progress(options.progress);

  Placement placement;
  placement.offsets.push_back(0);
  while (true) {
    const auto seeds = source.draw(*occupancy, options.seed_count);
    if (seeds.empty()) break;
    const auto outcome = contest.hold(seeds, *occupancy, progress);
    if (!outcome) {
      placement.end = PlacementEnd::cancelled;
      break;
    }
    // A seed from which no segment starts never gets one, because occupancy only grows.
    for (const auto& seed : outcome->useless) occupancy->retire_seed(seed);
    if (!outcome->longest) continue;
    append(mesh, *outcome->longest, placement);
    occupancy->add(*outcome->longest);
    source.add(*outcome->longest);
  }
  placement.statistics = placement_statistics(placement.lengths, placement.stop_reasons, directed_area(mesh, field),
                                              options.separation_distance, occupancy->coverage());
  placement.options = options;
  placement.options.progress = nullptr;
  return placement;
}

}  // namespace pectinate
