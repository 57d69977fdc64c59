// SPDX-License-Identifier: MIT
// What vector_projection.cpp compiles once for each kind of processor. Quotients and square roots are most of the work;
// lanes take several at once.

#include "detail/lane_triangles.inl"

/// Lines in the planes of triangles, whatever the input is like.
struct LaneDirections {
  LaneVector unit;
  Lanes share, tangent;  // what is left in the plane; how far the input stood out of it
  Lanes scale;           // the input's greatest component
  Mask is_finite;
};

inline LaneDirections project(const LaneVector& input, const LaneTriangles& triangles, const Lanes& areas) {
  const LaneVector ab = triangles.b - triangles.a, bc = triangles.c - triangles.b, ca = triangles.a - triangles.c;
  const LaneVector normal = cross(ab, triangles.c - triangles.a) / (2 * areas);
  LaneDirections result;
  result.is_finite = (input.x - input.x == 0) & (input.y - input.y == 0) & (input.z - input.z == 0);
  result.scale = greatest(greatest(magnitude(input.x), magnitude(input.y)), magnitude(input.z));
  const LaneVector scaled = input / result.scale;
  const LaneVector unit = scaled / root(dot(scaled, scaled));
  const Lanes height = dot(unit, normal);
  const LaneVector in_plane = unit - height * normal;
  result.share = root(dot(in_plane, in_plane));
  result.tangent = magnitude(height) / result.share;
  const LaneVector direction = in_plane / result.share;
  // The greatest product with a side tells the sign.
  Lanes product = dot(ab, direction);
  for (const auto& side : {bc, ca}) {
    const Lanes other = dot(side, direction);
    product = magnitude(other) > magnitude(product) ? other : product;
  }
  const auto with_sign = [&](const Lanes& x) { return product < 0 ? -x : x; };
  result.unit = {with_sign(direction.x), with_sign(direction.y), with_sign(direction.z)};
  return result;
}

inline PlanarDirections project_all(const SurfaceMesh& mesh, std::span<const Vec3> vectors) {
  PlanarDirections all;
  const std::size_t count = mesh.triangle_count();
  all.units = roomy_vector<Vec3>(count);
  all.status = roomy_vector<DirectionStatus>(count);
  all.out_of_plane_angles = roomy_vector<double>(count);
  for (std::size_t first = 0; first < count; first += doubles) {
    const auto triangle = [&](int lane) { return std::min(first + lane, count - 1); };
    const auto result = project(
        gather([&](int lane) -> const Vec3& { return vectors[mesh.input_triangle()[triangle(lane)]]; }),
        gather_triangles(mesh.vertices().data(), mesh.triangles(), first),
        lanes([&](int lane) { return mesh.triangle_areas()[triangle(lane)]; }));
    for (int lane = 0; lane < doubles && first + lane < count; ++lane) {
      const auto status = !result.is_finite[lane]             ? DirectionStatus::non_finite
                          : result.scale[lane] == 0           ? DirectionStatus::zero
                          : result.share[lane] <= least_share ? DirectionStatus::normal
                                                              : DirectionStatus::valid;
      const bool is_valid = status == DirectionStatus::valid;
      all.status.push_back(status);
      all.units.push_back(is_valid ? Vec3{result.unit.x[lane], result.unit.y[lane], result.unit.z[lane]} : Vec3{});
      all.out_of_plane_angles.push_back(is_valid ? angle_of_tangent(result.tangent[lane]) : 0);
    }
  }
  return all;
}
