// SPDX-License-Identifier: MIT
#include "detail/line_ends.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "detail/capsule.hpp"
#include "detail/chord_sides.hpp"
#include "detail/segment_grid.hpp"

namespace pectinate::detail {
namespace {

/// Shorter pieces are not worth a point; in separation distances.
constexpr double least_extension = 1e-3;
/// Chords longer than so many separation distances are left alone: so many others lie beside them that to look at all
/// would take longer than the placement.
constexpr double longest_chord_ahead = 64;

/// What a streamline takes of the chord ahead.
struct Extension {
  std::size_t line;
  int end;
  Chord chord;
  Vector start, far;  // of the chord
  double share = 0;   // of it, from `start`; none yet

  Vector point() const { return start + share * (far - start); }
};

class EndExtender {
 public:
  EndExtender(const StreamlineTracer& tracer, double clearance, Placement& placement)
      : tracer_(tracer), sheet_(tracer.sheet()), clearance_(clearance), placement_(placement) {}

  void run(const std::vector<ChordsAhead>& ahead) {
    extensions_.reserve(2 * ahead.size());
    for (std::size_t line = 0; line < ahead.size(); ++line) {
      for (const int end : {0, 1}) {
        const auto& chord = ahead[line][end];
        if (chord && chord->length <= longest_chord_ahead * separation(chord->triangle())) {
          extensions_.push_back({line, end, *chord, point_on(sheet_, *chord, entry_side(sheet_, *chord)),
                                 point_on(sheet_, *chord, exit_side(sheet_, *chord))});
        }
      }
    }
    if (extensions_.empty()) return;
    const auto grid = make_grid();
    for (std::size_t i = 0; i < extensions_.size(); ++i) extensions_[i].share = free_share(i, grid);
    std::erase_if(extensions_, [](const auto& extension) { return extension.share == 0; });
    store();
  }

 private:
  double reach() const {
    const auto& options = tracer_.options();
    const auto& varying = options.separation_distances;
    return (1 + guard) * (varying.empty() ? options.separation_distance : *std::ranges::max_element(varying));
  }

  // Segments have the numbers of their first points, extensions come after all points.
  std::int64_t point_count() const { return std::ssize(placement_.points); }
  Vector point(std::int64_t index) const { return vector(placement_.points[index]); }
  std::int64_t first_point(std::size_t line) const { return placement_.offsets[line]; }
  std::int64_t last_point(std::size_t line) const { return placement_.offsets[line + 1] - 1; }
  double separation(std::int32_t triangle) const { return tracer_.separation_distance(sheet_.mesh_triangle(triangle)); }
  std::int32_t mesh_triangle(const Extension& extension) const {
    return sheet_.mesh_triangle(extension.chord.triangle());
  }

  SegmentGrid make_grid() const {
    double total = std::accumulate(placement_.lengths.begin(), placement_.lengths.end(), 0.0);
    for (const auto& extension : extensions_) total += (extension.far - extension.start).norm();
    const auto visit_all = [&](const auto& visit) {
      for (std::size_t line = 0; line + 1 < placement_.offsets.size(); ++line) {
        for (auto i = first_point(line); i < last_point(line); ++i) {
          visit(static_cast<std::uint32_t>(i), point(i), point(i + 1));
        }
      }
      for (std::size_t i = 0; i < extensions_.size(); ++i) {
        visit(static_cast<std::uint32_t>(placement_.points.size() + i), extensions_[i].start, extensions_[i].far);
      }
    };
    return {reach(), placement_.points.size() + extensions_.size(), total, visit_all};
  }

  /// How much of its chord an extension may take.
  double free_share(std::size_t index, const SegmentGrid& grid) const {
    const auto& extension = extensions_[index];
    const Vector along = extension.far - extension.start;
    const double length = along.norm();
    const double least = least_extension * separation(extension.chord.triangle()) / length;
    double share = 1;
    bool is_cut = false;
    const auto keep_from = [&](const Vector& start, const Vector& end, double distance) {
      const double far = distance + ((end - start).norm() + share * length) / 2;
      if (((start + end - share * along) / 2 - extension.start).squaredNorm() > far * far) return;
      const auto inside = intersect({start, end, distance}, extension.start, along);
      if (!inside) return;
      share = std::min(share, inside->low);
      is_cut = true;
    };
    const auto is_wanted = [&](double along) { return along < share && share >= least; };
    const bool is_near_itself = placement_.stop_reasons[extension.line][extension.end] == StopReason::near_itself;
    for (const bool from_itself : {is_near_itself, !is_near_itself}) {
      if (from_itself) {
        visit_itself(index, keep_from);
      } else {
        visit_others(extension, grid, is_wanted, keep_from);
      }
      if (!is_cut) return 0;  // what stopped it was not found, but still does
    }
    return share < least ? 0 : share;
  }

  /// Calls visit(start, end, distance) for all segments of others that are near an extension, and some more.
  template <class IsWanted, class Visit>
  void visit_others(const Extension& extension, const SegmentGrid& grid, const IsWanted& is_wanted,
                    const Visit& visit) const {
    grid.visit_near(extension.start, extension.far, is_wanted, [&](std::int64_t segment) {
      if (segment >= point_count()) {
        const auto& other = extensions_[segment - point_count()];
        if (other.share == 0 || other.line == extension.line) return;
        const auto& placed_first = other.line < extension.line ? other : extension;
        visit(other.start, other.point(), stop_distance(mesh_triangle(placed_first)));
      } else if (segment < first_point(extension.line) || segment > last_point(extension.line)) {
        const bool was_first = segment < first_point(extension.line);
        const auto triangle = was_first ? placement_.point_triangles[segment] : mesh_triangle(extension);
        visit(point(segment), point(segment + 1), stop_distance(triangle));
      }
    });
  }

  /// How far those placed later keep from a streamline in a triangle.
  double stop_distance(std::int32_t triangle) const {
    return clearance_ * (1 + guard) * tracer_.separation_distance(triangle);
  }

  /// Calls visit(start, end, d_sep) for all segments of the streamline itself with more than 2 d_sep of it between
  /// (criterion 5).
  template <class Visit>
  void visit_itself(std::size_t index, const Visit& visit) const {
    const auto& extension = extensions_[index];
    const auto first = first_point(extension.line), last = last_point(extension.line);
    const double separation = tracer_.separation_distance(placement_.point_triangles[first]);
    double between = 0;
    const auto pass = [&](const Vector& start, const Vector& end) {
      if (between > 2 * separation) visit(start, end, (1 + guard) * separation);
      between += (end - start).norm();
    };
    if (extension.end == 0) {
      for (auto i = first; i < last; ++i) pass(point(i), point(i + 1));
    } else {
      for (auto i = last; i > first; --i) pass(point(i), point(i - 1));
      const auto* other = index > 0 ? &extensions_[index - 1] : nullptr;
      if (other && other->line == extension.line && other->share > 0) pass(other->start, other->point());
    }
  }

  /// Puts the new points and segments where they belong.
  void store() {
    for (const auto& extension : extensions_) {
      placement_.lengths[extension.line] += (extension.point() - extension.start).norm();
      if (extension.end == 0) continue;
      const auto joint = last_point(extension.line);  // points lie in the triangles of the segments after them
      placement_.point_triangles[joint] = mesh_triangle(extension);
      placement_.barycentric[joint] = weights(extension, 0);
    }
    const auto points_before = [&](std::size_t line) { return placement_.offsets[line]; };
    const auto segments_before = [&](std::size_t line) {
      return placement_.offsets[line] - static_cast<std::int64_t>(line);
    };
    insert(placement_.points, points_before, [&](const Extension& e) { return vec3(e.point()); });
    insert(placement_.barycentric, points_before, [&](const Extension& e) { return weights(e, e.share); });
    insert(placement_.point_triangles, points_before, [&](const Extension& e) { return mesh_triangle(e); });
    insert(placement_.segment_triangles, segments_before, [&](const Extension& e) { return mesh_triangle(e); });
    std::vector<std::int64_t> added(placement_.offsets.size(), 0);
    for (const auto& extension : extensions_) added[extension.line + 1] += 1;
    for (std::size_t line = 1; line < added.size(); ++line) {
      added[line] += added[line - 1];
      placement_.offsets[line] += added[line];
      placement_.seed_points[line - 1] = (placement_.offsets[line - 1] + placement_.offsets[line]) / 2;
    }
  }

  Vec3 weights(const Extension& extension, double share) const {
    const auto& chord = extension.chord;
    const Vec3 start = weights_on_side(sheet_, chord, entry_side(sheet_, chord));
    const Vec3 far = weights_on_side(sheet_, chord, exit_side(sheet_, chord));
    return vec3((1 - share) * vector(start) + share * vector(far));
  }

  /// Inserts a value for each extension before or behind those of its line; in place, from the back.
  template <class T, class Before, class Value>
  void insert(std::vector<T>& values, const Before& before, const Value& value) const {
    auto next = extensions_.rbegin();
    const auto insert_at = [&](std::size_t line, int end, auto place) {
      if (next == extensions_.rend() || next->line != line || next->end != end) return place;
      *--place = value(*next++);
      return place;
    };
    values.resize(values.size() + extensions_.size());
    auto place = values.end();
    for (auto line = placement_.offsets.size() - 1; line-- > 0;) {
      place = insert_at(line, 1, place);
      place = std::move_backward(values.begin() + before(line), values.begin() + before(line + 1), place);
      place = insert_at(line, 0, place);
    }
  }

  const StreamlineTracer& tracer_;
  const Sheet& sheet_;
  double clearance_;
  Placement& placement_;
  std::vector<Extension> extensions_;
};

}  // namespace

void extend_ends(const StreamlineTracer& tracer, double clearance, const std::vector<ChordsAhead>& ahead,
                 Placement& placement) {
  EndExtender(tracer, clearance, placement).run(ahead);
}

}  // namespace pectinate::detail
