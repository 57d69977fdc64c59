// SPDX-License-Identifier: MIT
#include "pectinate/demo_atrium.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "detail/left_atrium.hpp"
#include "detail/number_text.hpp"
#include "detail/surface_generation.hpp"
#include "detail/vec.hpp"
#include "pectinate/errors.hpp"
#include "pectinate/orientation_field.hpp"
#include "pectinate/surface_mesh.hpp"

namespace pectinate {
namespace {

using detail::Vector;

constexpr double shortest_edge = 0.2, longest_edge = 4;

/// How far the fibres of each part reach, in mm, and how strong those of the body are beside them.
constexpr double sleeve_reach = 7, annulus_reach = 9, appendage_reach = 5, bachmann_reach = 11;
constexpr double body_strength = 0.08;
constexpr double bachmann_height = 10;

void check(double edge_length) {
  if (!(edge_length >= shortest_edge && edge_length <= longest_edge)) {
    throw InvalidOption("edge_length is " + detail::number_text(edge_length) + " mm, but must be in [0.2, 4]");
  }
}

double fading(double distance, double reach) {
  return std::exp(-std::pow(std::max(distance, 0.0) / reach, 2));
}

/// The sum of lines d d^T, each with its weight; the principal direction of such a sum turns smoothly.
class LineBlend {
 public:
  /// Lines that run round an axis, tangent to the surface; they fade where it is seen from along the axis.
  void add_circles(const Vector& axis, const Vector& normal, double weight) { add_line(axis.cross(normal), weight); }
  void add_line(const Vector& d, double weight) { sum_ += weight * d * d.transpose(); }

  SymmetricTensor tensor() const { return {sum_(0, 0), sum_(1, 1), sum_(2, 2), sum_(0, 1), sum_(1, 2), sum_(0, 2)}; }

 private:
  Eigen::Matrix3d sum_ = Eigen::Matrix3d::Zero();
};

/// Circles round the veins, the valve and the appendage; from front to back over the roof of the body; across the front
/// below the roof, as Bachmann's bundle.
SymmetricTensor fibre_tensor(const detail::LeftAtrium& atrium, const Vector& point, const Vector& normal) {
  LineBlend blend;
  for (const auto& vein : atrium.veins) {
    const double weight = fading(detail::sample(vein.cone, point).value, sleeve_reach);
    blend.add_circles(vein.cone.axis(), normal, weight);
  }
  const auto& valve = atrium.mitral_valve;
  blend.add_circles(valve.normal, normal, fading(-valve.height(point), annulus_reach));
  for (const auto& part : atrium.appendage) {
    blend.add_circles(part.axis(), normal, fading(detail::sample(part, point).value, appendage_reach));
  }
  // Bachmann's bundle: turned by degrees, not blended, since a sum of crossing lines would turn at once.
  const double front = std::clamp(-normal.y(), 0.0, 1.0);
  const double band = fading(std::abs(point.z() - bachmann_height), bachmann_reach);
  const double turn = std::numbers::pi / 2 * front * front * band;
  const Vector over_the_roof = Vector::UnitX().cross(normal);
  blend.add_line(std::cos(turn) * over_the_roof + std::sin(turn) * normal.cross(over_the_roof), body_strength);
  return blend.tensor();
}

/// 0 for the body, 1 to 4 for the veins, 5 for the appendage: the part that the point is deepest in.
std::int32_t region_of(const detail::LeftAtrium& atrium, const Vector& point) {
  std::vector<double> depths{detail::sample_body(atrium, point).value};
  for (const auto& vein : atrium.veins) depths.push_back(detail::sample(vein.cone, point).value);
  depths.push_back(detail::sample_appendage(atrium, point).value);
  return static_cast<std::int32_t>(std::min_element(depths.begin(), depths.end()) - depths.begin());
}

}  // namespace

DemoAtrium make_demo_atrium(const DemoAtriumOptions& options) {
  check(options.edge_length);
  const auto atrium = detail::make_left_atrium();
  const auto cut = detail::triangulate(detail::make_surface(atrium), options.edge_length, detail::Finish::remeshed);

  DemoAtrium result;
  result.triangles = cut.surface.triangles;
  for (const auto& vertex : cut.surface.vertices) result.vertices.push_back(detail::vec3(vertex));
  const SurfaceMesh mesh(result.vertices, result.triangles);
  std::vector<SymmetricTensor> tensors;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto& [a, b, c] = result.triangles[t];
    const Vector centroid = (cut.surface.vertices[a] + cut.surface.vertices[b] + cut.surface.vertices[c]) / 3;
    tensors.push_back(fibre_tensor(atrium, centroid, detail::vector(mesh.triangle_normals()[t])));
    result.regions.push_back(region_of(atrium, centroid));
  }
  result.directions = OrientationField::from_triangle_tensors(mesh, tensors).directions();

  result.region_names.emplace_back("body");
  result.loops.push_back({"mitral_valve", cut.loops[0]});
  for (std::size_t i = 0; i < atrium.veins.size(); ++i) {
    result.region_names.push_back(atrium.veins[i].name);
    result.loops.push_back({atrium.veins[i].name, cut.loops[i + 1]});
  }
  result.region_names.emplace_back("left_atrial_appendage");
  return result;
}

}  // namespace pectinate
