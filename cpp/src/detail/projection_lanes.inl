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

/// Of small tangents by three terms of the series, to the last bit.
inline Lanes angles_of_tangents(const Lanes& tangents) {
  const Lanes squares = tangents * tangents;
  const Lanes angles = tangents - tangents * squares * (1.0 / 3 - squares / 5);
  const Mask are_small = tangents < 1e-5;
  if (is_set_everywhere(are_small)) return angles;
  return lanes([&](int lane) { return are_small[lane] ? angles[lane] : std::atan(tangents[lane]); });
}

/// What is found is put together in a small block, because to lengthen vectors one by one takes as long as to compute.
struct DirectionBlock {
  static constexpr std::size_t size = 64;  // a multiple of the number of lanes
  std::array<Vec3, size> units;
  std::array<DirectionStatus, size> status;
  std::array<double, size> angles;

  void set(std::size_t first, const LaneDirections& found) {
    const auto as_lanes = [](DirectionStatus one) { return Mask{} + static_cast<int>(one); };
    Mask found_status =
        found.share <= least_share ? as_lanes(DirectionStatus::normal) : as_lanes(DirectionStatus::valid);
    found_status = found.scale == 0 ? as_lanes(DirectionStatus::zero) : found_status;
    found_status = found.is_finite ? found_status : as_lanes(DirectionStatus::non_finite);
    const Mask is_valid = found_status == as_lanes(DirectionStatus::valid);
    const auto if_valid = [&](const Lanes& x) { return is_valid ? x : all(0); };
    const Lanes x = if_valid(found.unit.x), y = if_valid(found.unit.y), z = if_valid(found.unit.z);
    const Lanes angle = angles_of_tangents(if_valid(found.tangent));
    for (int lane = 0; lane < doubles; ++lane) {
      units[first + lane] = {x[lane], y[lane], z[lane]};
      angles[first + lane] = angle[lane];
      status[first + lane] = static_cast<DirectionStatus>(found_status[lane]);
    }
  }

  void append_to(PlanarDirections& all, std::size_t count) const {
    all.units.insert(all.units.end(), units.begin(), units.begin() + count);
    all.status.insert(all.status.end(), status.begin(), status.begin() + count);
    all.out_of_plane_angles.insert(all.out_of_plane_angles.end(), angles.begin(), angles.begin() + count);
  }
};

inline void project_all(const SurfaceMesh& mesh, std::span<const Vec3> vectors, PlanarDirections& all) {
  const std::size_t count = mesh.triangle_count();
  DirectionBlock block;
  for (std::size_t begin = 0; begin < count; begin += block.size) {
    const auto end = std::min(begin + block.size, count);
    for (auto first = begin; first < end; first += doubles) {
      const auto triangle = [&](int lane) { return std::min(first + lane, count - 1); };
      block.set(first - begin,
                project(gather([&](int lane) -> const Vec3& { return vectors[mesh.input_triangle()[triangle(lane)]]; }),
                        gather_triangles(mesh.vertices().data(), mesh.triangles(), first),
                        lanes([&](int lane) { return mesh.triangle_areas()[triangle(lane)]; })));
    }
    block.append_to(all, end - begin);
  }
}
