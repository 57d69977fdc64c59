// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "detail/chord_measures.hpp"
#include "detail/chord_shadow.hpp"
#include "detail/random.hpp"
#include "detail/segments.hpp"

namespace pectinate::detail {

// As the engine compiles them.
namespace shadow_variants {
#define PECTINATE_KERNEL "detail/chord_shadow_lanes.inl"
#include "detail/kernel_variants.inl"
}  // namespace shadow_variants
namespace measure_variants {
#define PECTINATE_KERNEL "detail/chord_measures_lanes.inl"
#include "detail/kernel_variants.inl"
}  // namespace measure_variants
namespace segment_variants {
#define PECTINATE_KERNEL "detail/segments_lanes.inl"
#include "detail/kernel_variants.inl"
}  // namespace segment_variants
namespace triangle_variants {
#define PECTINATE_KERNEL "detail/triangle_measures_lanes.inl"
#include "detail/kernel_variants.inl"
}  // namespace triangle_variants

#ifdef PECTINATE_HAS_VARIANTS
/// Does something with each variant that this processor can run, but for any_processor.
#define FOR_EACH_VARIANT(kernel, ...)        \
  if (kernel::has_avx2) {                    \
    namespace variant = kernel::with_avx2;   \
    __VA_ARGS__                              \
  }                                          \
  if (kernel::has_avx512) {                  \
    namespace variant = kernel::with_avx512; \
    __VA_ARGS__                              \
  }

namespace {

Vector draw_vector(Random& random) {
  const double x = random.unit(), y = random.unit(), z = random.unit();
  return {2 * x - 1, 2 * y - 1, 2 * z - 1};
}

template <class Value>
bool same_bytes(const Value& a, const Value& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

bool same_bits(const SegmentsNear& a, const SegmentsNear& b) {
  return a.are_near == b.are_near && a.lie_before == b.lie_before && a.lie_beyond == b.lie_beyond;
}

}  // namespace

TEST_CASE("kernels: the same bytes on any processor, for shadows and cores") {
  Random random(11);
  int some = 0;
  for (int round = 0; round < 20000; ++round) {
    std::array<std::array<Vector, 5>, shadow_lanes> places;
    ShadowQuestions questions;
    for (int lane = 0; lane < shadow_lanes; ++lane) {
      for (auto& place : places[lane]) place = draw_vector(random);
      questions.low[lane] = &places[lane][0];
      questions.middle[lane] = &places[lane][1];
      questions.high[lane] = &places[lane][2];
      questions.split[lane] = 0.02 + 0.96 * random.unit();
      questions.start[lane] = &places[lane][3];
      questions.end[lane] = &places[lane][round % 7 == 0 ? 3 : 4];
      questions.radius[lane] = random.unit();
    }
    const auto shadows = shadow_variants::any_processor::chord_shadows(questions);
    const auto cores = shadow_variants::any_processor::chord_cores(questions);
    FOR_EACH_VARIANT(shadow_variants, {
      CHECK(same_bytes(shadows, variant::chord_shadows(questions)));
      CHECK(same_bytes(cores, variant::chord_cores(questions)));
    });
    for (int lane = 0; lane < shadow_lanes; ++lane) some += shadows.chords.low[lane] <= shadows.chords.high[lane];
  }
  CHECK(some > 20000);
}

TEST_CASE("kernels: the same bytes on any processor, for chords' measures") {
  Random random(13);
  const auto draw = [&] { return vec3(draw_vector(random).normalized()); };
  unsigned along_sides = 0;
  for (int round = 0; round < 5000; ++round) {
    std::array<std::array<Vec3, 4>, measured_lanes> places;
    Faces faces;
    for (int lane = 0; lane < measured_lanes; ++lane) {
      auto& [a, b, c, direction] = places[lane];
      for (auto* place : {&a, &b, &c, &direction}) *place = draw();
      if (round % 5 == lane) direction = vec3((vector(b) - vector(a)).normalized());
      for (int k = 0; k < 3; ++k) faces.corners[k][lane] = &places[lane][k];
      faces.directions[lane] = &direction;
    }
    const auto measures = measure_variants::any_processor::measure_chords(faces);
    FOR_EACH_VARIANT(measure_variants, {
      const auto others = variant::measure_chords(faces);
      CHECK(same_bytes(measures.cosine, others.cosine));
      CHECK(same_bytes(measures.middle, others.middle));
      CHECK(same_bytes(measures.split, others.split));
      CHECK(same_bytes(measures.longest_chord, others.longest_chord));
      CHECK(same_bytes(measures.width, others.width));
      CHECK(measures.along_sides == others.along_sides);
    });
    along_sides |= measures.along_sides;
  }
  CHECK(along_sides == 15);
}

TEST_CASE("kernels: the same bytes on any processor, for areas and volumes") {
  Random random(14);
  for (std::size_t count = 1; count < 40; ++count) {
    std::vector<Vec3> vertices(30);
    for (auto& vertex : vertices) vertex = vec3(draw_vector(random));
    std::vector<Triangle> triangles(count);
    for (auto& triangle : triangles) {
      for (auto& corner : triangle) corner = static_cast<std::int32_t>(random.below(vertices.size()));
    }
    const Vec3 apex = vec3(draw_vector(random));
    std::vector<double> areas(count), others(count);
    triangle_variants::any_processor::measure_areas(vertices.data(), triangles, areas.data());
    const double volume = triangle_variants::any_processor::measure_volume(vertices.data(), triangles, apex);
    FOR_EACH_VARIANT(triangle_variants, {
      variant::measure_areas(vertices.data(), triangles, others.data());
      CHECK(std::memcmp(areas.data(), others.data(), count * sizeof(double)) == 0);
      CHECK(same_bytes(volume, variant::measure_volume(vertices.data(), triangles, apex)));
    });
  }
}

TEST_CASE("kernels: the same bytes on any processor, for distances and choices") {
  Random random(12);
  unsigned near = 0, before = 0, beyond = 0;
  for (int round = 0; round < 5000; ++round) {
    Segments segments{};
    const auto count = static_cast<int>(1 + random.below(Segments::most));
    for (int i = 0; i < count; ++i) {
      segments.add(draw_vector(random), 0.3 * draw_vector(random), static_cast<float>(random.unit()));
    }
    segments.fill_up();
    const auto point = float_point(draw_vector(random));
    const float distance = segment_variants::any_processor::distance(segments, point);
    FOR_EACH_VARIANT(segment_variants, {
      auto others = segments;
      others.square.fill(0);
      CHECK(variant::distance(others, point) == distance);
      CHECK(same_bytes(segments.square, others.square));
    });
    const auto corner = [&] { return float_point(0.2 * draw_vector(random)); };
    const TriangleQuestion question{{corner(), corner(), corner()}, 0.1F, 0.7F, 1e-6F};
    for (int group = 0; group < count; group += Segments::group_size) {
      const auto found = segment_variants::any_processor::segments_near(segments, group, question);
      FOR_EACH_VARIANT(segment_variants, CHECK(same_bits(found, variant::segments_near(segments, group, question))););
      near |= found.are_near;
      before |= found.lie_before;
      beyond |= found.lie_beyond;
    }
  }
  CHECK((near == 255 && before == 255 && beyond == 255));
}
#endif

}  // namespace pectinate::detail
