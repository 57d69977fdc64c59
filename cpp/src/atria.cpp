// SPDX-License-Identifier: MIT
#include "pectinate/atria.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "detail/atria_anatomy.hpp"
#include "detail/number_text.hpp"
#include "detail/surface_generation.hpp"
#include "detail/vec.hpp"
#include "pectinate/errors.hpp"

namespace pectinate {
namespace {

using detail::Chamber;
using detail::Vector;

constexpr double shortest_edge = 0.1, longest_edge = 2;

void check(AtrialSurface which, AtrialLayer layer, double edge_length) {
  if (!(edge_length >= shortest_edge && edge_length <= longest_edge)) {
    throw InvalidOption("edge_length is " + detail::number_text(edge_length) + " mm, but must be in [0.1, 2]");
  }
  if (layer != AtrialLayer::epicardium && layer != AtrialLayer::endocardium) {
    throw InvalidOption("there is no atrial layer number " + std::to_string(static_cast<int>(layer)));
  }
  if (which == AtrialSurface::bachmann_bundle && layer == AtrialLayer::endocardium) {
    throw InvalidOption("Bachmann's bundle has no endocardium; ask for its epicardium");
  }
}

Chamber make_chamber(AtrialSurface which) {
  switch (which) {
    case AtrialSurface::left_atrium:
      return detail::make_left_chamber();
    case AtrialSurface::right_atrium:
      return detail::make_right_chamber();
    case AtrialSurface::bachmann_bundle:
      return detail::make_bachmann_bundle();
  }
  throw InvalidOption("there is no atrial surface number " + std::to_string(static_cast<int>(which)));
}

detail::ImplicitSurface make_surface(const Chamber& chamber, AtrialLayer layer) {
  const double inwards = layer == AtrialLayer::endocardium ? atrial_wall_thickness : 0;
  const auto function = [=, outside = chamber.function](const Vector& point) {
    return detail::offset(outside(point), -inwards);
  };
  detail::ImplicitSurface surface{function, {}, chamber.bounds};
  for (const auto& opening : chamber.openings) surface.cuts.push_back(opening.cut);
  return surface;
}

/// The part that the point is deepest in.
std::int32_t region_of(const Chamber& chamber, const Vector& point) {
  std::vector<double> depths;
  depths.reserve(chamber.parts.size());
  for (const auto& part : chamber.parts) depths.push_back(part.function(point).value);
  return static_cast<std::int32_t>(std::min_element(depths.begin(), depths.end()) - depths.begin());
}

}  // namespace

GeneratedSurface make_atrial_surface(AtrialSurface which, AtrialLayer layer, const AtriaOptions& options) {
  check(which, layer, options.edge_length);
  const Chamber chamber = make_chamber(which);
  auto cut = detail::triangulate(make_surface(chamber, layer), options.edge_length, detail::Finish::opened_angles);

  GeneratedSurface result;
  const auto& vertices = cut.surface.vertices;
  for (const auto& vertex : vertices) result.vertices.push_back(detail::vec3(vertex));
  for (const auto& [a, b, c] : cut.surface.triangles)
    result.regions.push_back(region_of(chamber, (vertices[a] + vertices[b] + vertices[c]) / 3));
  result.triangles = std::move(cut.surface.triangles);
  for (const auto& part : chamber.parts) result.region_names.push_back(part.name);
  for (std::size_t i = 0; i < chamber.openings.size(); ++i)
    result.loops.push_back({chamber.openings[i].name, std::move(cut.loops[i])});
  return result;
}

}  // namespace pectinate
