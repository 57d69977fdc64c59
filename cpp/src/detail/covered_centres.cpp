// SPDX-License-Identifier: MIT
#include "detail/covered_centres.hpp"

#include <algorithm>

namespace pectinate::detail {
namespace {

/// Segments of a line that are first looked at together.
constexpr std::size_t segments_in_bundle = 8;

}  // namespace

CoveredCentres::CoveredCentres(const SurfaceMesh& mesh, const StreamlineTracer& tracer, double clearance)
    : mesh_(mesh), tracer_(tracer), sheet_(tracer.sheet()), clearance_(clearance), counts_(mesh.triangle_count(), 0) {}

std::vector<CoveredCentres::Bundle> CoveredCentres::bundles_of(const Polyline& line) const {
  std::vector<Bundle> bundles;
  for (std::size_t first = 0; first < line.triangles.size(); first += segments_in_bundle) {
    Bundle bundle{first, std::min(first + segments_in_bundle, line.triangles.size()), Vector::Zero(), 0};
    bundle.centre = (line.points[bundle.first] + line.points[bundle.last]) / 2;
    double greatest = 0, widest = 0;
    for (auto i = bundle.first; i < bundle.last; ++i) widest = std::max(widest, reach(line.triangles[i]));
    for (auto i = bundle.first; i <= bundle.last; ++i) {
      greatest = std::max(greatest, (line.points[i] - bundle.centre).norm());
    }
    bundle.radius = greatest + widest;
    bundles.push_back(bundle);
  }
  return bundles;
}

bool CoveredCentres::is_covered(const Vector& point, const Polyline& line, const Bundle& bundle) const {
  if ((point - bundle.centre).squaredNorm() > bundle.radius * bundle.radius) return false;
  for (auto i = bundle.first; i < bundle.last; ++i) {
    if (distance_to_segment(point, line.points[i], line.points[i + 1]) <= reach(line.triangles[i])) return true;
  }
  return false;
}

void CoveredCentres::add(std::int32_t line, const Polyline& polyline, const std::vector<std::int32_t>& triangles) {
  if (line >= std::ssize(covered_)) covered_.resize(line + 1);
  covered_[line].clear();
  auto bundles = bundles_of(polyline);
  auto last = bundles.begin();  // what covered the centre before likely covers the next
  for (const auto t : triangles) {
    const Vector centre = (sheet_.low(t) + sheet_.middle(t) + sheet_.high(t)) / 3;
    const auto covers = [&](const Bundle& bundle) { return is_covered(centre, polyline, bundle); };
    auto found = std::find_if(last, bundles.end(), covers);
    if (found == bundles.end()) {
      found = std::find_if(bundles.begin(), last, covers);
      if (found == last) continue;
    }
    last = found;
    covered_[line].push_back(t);
  }
  put_back({&line, 1});
}

void CoveredCentres::take_back(std::span<const std::int32_t> lines) {
  for (const auto line : lines) {
    for (const auto t : covered_[line]) {
      if (--counts_[t] == 0) uncovered_area_ += area(t);
    }
  }
}

void CoveredCentres::put_back(std::span<const std::int32_t> lines) {
  for (const auto line : lines) {
    for (const auto t : covered_[line]) {
      if (counts_[t]++ == 0) uncovered_area_ -= area(t);
    }
  }
}

}  // namespace pectinate::detail
