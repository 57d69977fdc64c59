// SPDX-License-Identifier: MIT
#include "detail/placement_options.hpp"

#include <cmath>
#include <string>

#include "detail/number_text.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::detail {
namespace {

/// More would only take memory and keep the callback waiting.
constexpr int most_seeds = 1'000'000;

void check_polishing(const PlacementOptions& options) {
  if (options.polishing_rounds < 0) {
    throw InvalidOption("polishing_rounds is " + std::to_string(options.polishing_rounds) +
                        ", but must not be negative; 0 turns polishing off");
  }
  if (!(options.polishing_time >= 0 && std::isfinite(options.polishing_time))) {
    throw InvalidOption("polishing_time is " + number_text(options.polishing_time) +
                        ", but must be finite and not negative; 0 is no limit");
  }
  if (polishes(options) && options.method != PlacementMethod::longest) {
    throw InvalidOption(
        "polishing needs method longest; choose that, or leave polishing_rounds and polishing_time at 0");
  }
}

}  // namespace

void check(const PlacementOptions& options) {
  if (options.seed_count < 1 || options.seed_count > most_seeds) {
    throw InvalidOption("seed_count is " + std::to_string(options.seed_count) + ", but must be in [1, 1000000]");
  }
  if (!(options.seed_distance_factor >= 1 && options.seed_distance_factor < 1e6)) {
    throw InvalidOption("seed_distance_factor is " + number_text(options.seed_distance_factor) +
                        ", but must be at least 1 and finite: nearer than d_sep nothing is free");
  }
  if (options.method == PlacementMethod::longest && options.occupancy != OccupancyModel::exact) {
    throw InvalidOption("method longest needs exact occupancy; choose another method for the edge mask");
  }
  if (!(options.seed_clearance >= 1 && options.seed_clearance <= 2)) {
    throw InvalidOption("seed_clearance is " + number_text(options.seed_clearance) + ", but must be in [1, 2]");
  }
  if (!(options.test_distance > 0 && options.test_distance <= 1)) {
    throw InvalidOption("test_distance is " + number_text(options.test_distance) + ", but must be in (0, 1]");
  }
  const bool strict = options.seed_clearance == 1 && options.test_distance == 1;
  if (!strict && options.occupancy != OccupancyModel::exact) {
    throw InvalidOption("seed_clearance and test_distance need exact occupancy; leave them at 1 for the edge mask");
  }
  if (!(options.minimum_length >= 0 && std::isfinite(options.minimum_length))) {
    throw InvalidOption("minimum_length is " + number_text(options.minimum_length) +
                        ", but must be finite and not negative");
  }
  if (options.close_loops && options.method != PlacementMethod::longest) {
    throw InvalidOption("close_loops needs method longest; choose that, or leave it off");
  }
  if (!(options.singularity_radius >= 0 && std::isfinite(options.singularity_radius))) {
    throw InvalidOption("singularity_radius is " + number_text(options.singularity_radius) +
                        ", but must be finite and not negative; 0 turns it off");
  }
  if (options.singularity_radius > 0 && options.occupancy != OccupancyModel::exact) {
    throw InvalidOption("singularity_radius needs exact occupancy; leave it at 0 for the edge mask");
  }
  check_polishing(options);
  if (options.thread_count < 1 || options.thread_count > 1024) {
    throw InvalidOption("thread_count is " + std::to_string(options.thread_count) + ", but must be in [1, 1024]");
  }
}

}  // namespace pectinate::detail
