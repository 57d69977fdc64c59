// SPDX-License-Identifier: MIT
#include "pectinate/placement.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <optional>

#include "detail/chord_occupancy.hpp"
#include "detail/edge_point.hpp"
#include "detail/line_ends.hpp"
#include "detail/longest_first.hpp"
#include "detail/placed_lines.hpp"
#include "detail/placement_options.hpp"
#include "detail/polishing.hpp"
#include "detail/random.hpp"
#include "detail/seed_ring.hpp"
#include "detail/sheet.hpp"
#include "detail/thread_pool.hpp"
#include "detail/vec.hpp"
#include "pectinate/field_topology.hpp"
#include "pectinate/occupancy.hpp"

namespace pectinate {
namespace {

using Clock = std::chrono::steady_clock;
using WorkspacePointer = decltype(StreamlineTracer::make_workspace());

constexpr auto progress_interval = std::chrono::milliseconds(50);
/// A callback that takes long, on a large surface, is called more seldom: at most this share of the time is its.
constexpr int slowest_share = 20;
/// Candidates that a thread traces between two looks at the clock.
constexpr std::int64_t candidates_per_look = 16;
/// To wake another thread takes about as long as tracing so many points.
constexpr std::int64_t least_shared_points = 4000;

Clearance clearance_of(const PlacementOptions& options) {
  return {options.test_distance, options.seed_clearance};
}

SingularRegion singular_region(const SurfaceMesh& mesh, const OrientationField& field, double radius) {
  SingularRegion region{{}, radius};
  if (radius == 0) return region;
  for (const auto& singularity : field_topology(mesh, field).singularities) {
    region.vertices.push_back(singularity.vertex);
  }
  return region;
}

/// Points a triangle for which room is made beforehand.
constexpr double most_reserved = 16;

/// To look at the clock is not free.
constexpr int questions_per_look = 8;

/// Asks the user's callback now and then whether to go on.
class Progress {
 public:
  explicit Progress(const std::function<bool(double)>& callback) : callback_(callback) {}

  /// `coverage` is a function: counting may take a while.
  template <class Coverage>
  bool is_cancelled(const Coverage& coverage) {
    if (!callback_ || cancelled_ || question_count_++ % questions_per_look != 0) return cancelled_;
    if (Clock::now() - last_call_ < interval_) return false;
    const auto start = Clock::now();
    cancelled_ = !callback_(coverage());
    last_call_ = Clock::now();
    interval_ = std::max<Clock::duration>(progress_interval, slowest_share * (last_call_ - start));
    return cancelled_;
  }

 private:
  const std::function<bool(double)>& callback_;
  Clock::time_point last_call_{};
  Clock::duration interval_ = progress_interval;
  std::int64_t question_count_ = 0;
  bool cancelled_ = false;
};

/// When polishing ends.
class Limits {
 public:
  explicit Limits(const PlacementOptions& options)
      : rounds_(options.polishing_rounds), seconds_(options.polishing_time) {}

  bool are_reached(std::int64_t rounds) const {
    if (rounds_ > 0 && rounds >= rounds_) return true;
    return seconds_ > 0 && std::chrono::duration<double>(Clock::now() - start_).count() >= seconds_;
  }

 private:
  std::int64_t rounds_;
  double seconds_;
  Clock::time_point start_ = Clock::now();
};

/// Draws the seed points of one step by the paper's three methods.
class SeedSource {
 public:
  SeedSource(const SurfaceMesh& mesh, const StreamlineTracer& tracer, const PlacementOptions& options)
      : method_(options.method), random_(options.random_seed) {
    if (method_ == PlacementMethod::distance) {
      ring_.emplace(mesh, tracer, options.seed_distance_factor);
    }
  }

  void add(const Streamline& streamline) {
    if (ring_) ring_->add(streamline);
  }

  /// Up to `count` points; fewer only if nothing is free.
  std::vector<Seed> draw(const Occupancy& occupancy, int count) {
    std::vector<Seed> seeds;
    seeds.reserve(count);
    for (int i = 0; i < count; ++i) {
      const auto seed = draw_one(occupancy);
      if (!seed) break;
      seeds.push_back(*seed);
    }
    return seeds;
  }

 private:
  std::optional<Seed> draw_one(const Occupancy& occupancy) {
    std::optional<Seed> seed;
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
  Contest(const StreamlineTracer& tracer, double minimum_length, int thread_count)
      : tracer_(tracer), minimum_length_(minimum_length), pool_(thread_count), desks_(pool_.thread_count()) {}

  struct Outcome {
    const Streamline* longest = nullptr;  // none if no candidate is long enough
    std::vector<Seed> useless;            // seeds of candidates that are not
  };

  /// None if it was cancelled.
  std::optional<Outcome> hold(const std::vector<Seed>& seeds, const Occupancy& occupancy, Progress& progress) {
    const auto points_before = point_count();  // this contest will have about as many
    for (auto& desk : desks_) desk.start();
    lengths_.assign(seeds.size(), 0);
    const auto count = static_cast<std::int64_t>(seeds.size());
    for (std::int64_t first = 0, last = 0; first < count; first = last) {
      if (progress.is_cancelled([&] { return occupancy.coverage(); })) return std::nullopt;
      const bool is_shared = std::max(points_before, point_count()) >= least_shared_points;
      last = std::min(count, first + candidates_per_look * (is_shared ? pool_.thread_count() : 1));
      const auto work = [&](std::int64_t index, int thread) {
        trace(first + index, seeds[first + index], occupancy, desks_[thread]);
      };
      if (is_shared) {
        pool_.run(last - first, work);
      } else {
        for (std::int64_t index = 0; index < last - first; ++index) work(index, 0);
      }
    }
    return judge(seeds);
  }

 private:
  static constexpr std::int64_t none = -1;

  /// One thread's place of work.
  struct Desk {
    WorkspacePointer best = StreamlineTracer::make_workspace(), current = StreamlineTracer::make_workspace();
    const Streamline* best_line = nullptr;
    std::int64_t winner = none, point_count = 0;

    void start() {
      winner = none;
      point_count = 0;
    }
  };

  /// Of all candidates of the last contest, or of that at hand.
  std::int64_t point_count() const {
    return std::accumulate(desks_.begin(), desks_.end(), std::int64_t{0},
                           [](std::int64_t sum, const Desk& desk) { return sum + desk.point_count; });
  }

  void trace(std::int64_t index, const Seed& seed, const Occupancy& occupancy, Desk& desk) {
    const auto& line = tracer_.trace(seed, &occupancy, *desk.current);
    desk.point_count += std::ssize(line.points);
    lengths_[index] = line.length >= minimum_length_ ? line.length : 0;
    if (lengths_[index] > 0 && (desk.winner == none || lengths_[index] > lengths_[desk.winner])) {
      std::swap(desk.best, desk.current);
      desk.best_line = &line;
      desk.winner = index;
    }
  }

  Outcome judge(const std::vector<Seed>& seeds) const {
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
  double minimum_length_;
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

/// As many points as there can be: streamlines d_sep apart cross a triangle so wide across the field width / d_sep
/// times. To move what is full to twice as much memory costs three times the result, room not written to nothing.
std::size_t most_points(const StreamlineTracer& tracer) {
  const auto& options = tracer.options();
  const auto& varying = options.separation_distances;
  const double least = varying.empty() ? options.separation_distance : *std::ranges::min_element(varying);
  double width = 0;
  for (const auto& crossings : tracer.sheet().crossings) width += crossings.width;
  return static_cast<std::size_t>(std::min(width / least, most_reserved * tracer.sheet().triangle_count()));
}

/// The mean of d_sep over the length of the streamlines.
double mean_separation(const StreamlineTracer& tracer, const Placement& placement) {
  const auto& constant = tracer.options();
  if (constant.separation_distances.empty()) return constant.separation_distance;
  double moment = 0, length = 0;
  for (std::size_t i = 0; i + 1 < placement.offsets.size(); ++i) {
    for (auto p = placement.offsets[i]; p + 1 < placement.offsets[i + 1]; ++p) {
      const double piece = (detail::vector(placement.points[p + 1]) - detail::vector(placement.points[p])).norm();
      moment += piece * tracer.separation_distance(placement.segment_triangles[p - static_cast<std::int64_t>(i)]);
      length += piece;
    }
  }
  return length > 0 ? moment / length : 0;
}

/// What streamlines are placed on.
struct Ground {
  const SurfaceMesh& mesh;
  const StreamlineTracer& tracer;
  SingularRegion singular;
};

/// The paper's loop. Returns the coverage.
double place_by_contest(const Ground& ground, const PlacementOptions& options, Progress& progress,
                        Placement& placement) {
  const auto& [mesh, tracer, singular] = ground;
  const auto occupancy = options.occupancy == OccupancyModel::exact
                             ? make_exact_occupancy(mesh, tracer, clearance_of(options), singular)
                             : make_edge_mask(mesh, tracer);
  detail::reserve(most_points(tracer), placement);
  SeedSource source(mesh, tracer, options);
  Contest contest(tracer, options.minimum_length, options.thread_count);
  while (true) {
    const auto seeds = source.draw(*occupancy, options.seed_count);
    if (seeds.empty()) break;
    const auto outcome = contest.hold(seeds, *occupancy, progress);
    if (!outcome) {
      placement.end = PlacementEnd::cancelled;
      break;
    }
    // A seed that gives no streamline never gives one, because occupancy only grows.
    for (const auto& seed : outcome->useless) occupancy->retire_seed(seed);
    if (!outcome->longest) continue;
    append(mesh, *outcome->longest, placement);
    occupancy->add(*outcome->longest);
    source.add(*outcome->longest);
  }
  return occupancy->coverage();
}

/// Finds streamlines, the longest first, and polishes them. Returns the coverage.
double find_longest(const Ground& ground, const PlacementOptions& options, Progress& progress,
                    detail::PlacedLines& lines, Placement& placement) {
  detail::ChordOccupancy occupancy(ground.mesh, ground.tracer, clearance_of(options), ground.singular);
  const detail::LineRules rules{options.minimum_length, options.close_loops};
  const auto place = [&](const auto& line) { lines.add(line); };
  const auto go_on = [&] { return !progress.is_cancelled([&] { return occupancy.coverage(); }); };
  bool complete = true;
  if (detail::polishes(options)) {
    detail::Polisher polisher(ground.mesh, ground.tracer, rules, occupancy, options.random_seed);
    complete = polisher.fill(go_on);
    if (complete) {
      const Limits limits(options);
      placement.statistics.polishing_rounds = polisher.polish([&](std::int64_t rounds) {
        if (limits.are_reached(rounds)) return false;
        complete = go_on();
        return complete;
      });
    }
    polisher.for_each(place);
  } else {
    complete = detail::LineFiller(ground.mesh, ground.tracer, rules, occupancy, place).fill(go_on);
  }
  if (!complete) placement.end = PlacementEnd::cancelled;
  return occupancy.coverage();
}

/// The longest first. Returns the coverage. One after the other, what takes memory: occupancy, chords, and what is
/// needed to let ends run on.
double place_longest(const Ground& ground, const PlacementOptions& options, Progress& progress, Placement& placement) {
  const auto& sheet = ground.tracer.sheet();
  std::vector<detail::ChordsAhead> ahead;
  double coverage = 0;
  {
    detail::PlacedLines lines(most_points(ground.tracer));
    coverage = find_longest(ground, options, progress, lines, placement);
    lines.write(sheet, placement);
    ahead.reserve(lines.count());
    for (std::size_t i = 0; i < lines.count(); ++i) ahead.push_back(chords_ahead(sheet, lines[i]));
  }
  detail::extend_ends(ground.tracer, options.test_distance, ahead, placement);
  return coverage;
}

}  // namespace

Placement place_streamlines(const SurfaceMesh& mesh, const OrientationField& field, const PlacementOptions& options) {
  detail::check(options);
  const StreamlineTracer tracer(
      mesh, field,
      {options.separation_distance, options.separation_distances, options.abrupt_turn_angle, options.max_steps});
  Progress progress(options.progress);
  Placement placement;
  placement.offsets.push_back(0);
  const auto place = options.method == PlacementMethod::longest ? place_longest : place_by_contest;
  const double coverage =
      place({mesh, tracer, singular_region(mesh, field, options.singularity_radius)}, options, progress, placement);
  const auto polishing_rounds = placement.statistics.polishing_rounds;
  placement.statistics = placement_statistics(placement.lengths, placement.stop_reasons, tracer.sheet().directed_area,
                                              mean_separation(tracer, placement), coverage);
  placement.statistics.polishing_rounds = polishing_rounds;
  placement.options = options;
  placement.options.progress = nullptr;
  return placement;
}

}  // namespace pectinate
