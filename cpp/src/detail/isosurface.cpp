// SPDX-License-Identifier: MIT
#include "detail/isosurface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace pectinate::detail {

namespace {

/// Values at the points of a regular grid that overlaps the bounding box on every side.
class Grid {
 public:
  Grid(const ImplicitSurface& surface, double cell_size) : origin_(surface.bounds.lower), cell_size_(cell_size) {
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = surface.bounds.upper[axis] - surface.bounds.lower[axis];
      cell_counts_[axis] = static_cast<int>(std::ceil(extent / cell_size));
    }
    const int point_count = (cell_counts_[0] + 1) * (cell_counts_[1] + 1) * (cell_counts_[2] + 1);
    values_.reserve(point_count);
    for (int index = 0; index < point_count; ++index) values_.push_back(surface.function(point(index)).value);
  }

  const std::array<int, 3>& cell_counts() const { return cell_counts_; }
  double value(int index) const { return values_[index]; }
  int index(int i, int j, int k) const { return (k * (cell_counts_[1] + 1) + j) * (cell_counts_[0] + 1) + i; }
  Vector point(int index) const {
    const int nx = cell_counts_[0] + 1, ny = cell_counts_[1] + 1;
    const int i = index % nx, j = index / nx % ny, k = index / (nx * ny);
    return origin_ + cell_size_ * Vector(i, j, k);
  }

 private:
  Vector origin_;
  double cell_size_;
  std::array<int, 3> cell_counts_;
  std::vector<double> values_;
};

class TetrahedronMarcher {
 public:
  explicit TetrahedronMarcher(const Grid& grid) : grid_(grid) {}

  void march(const std::array<int, 4>& corners) {
    std::array<int, 4> sorted = corners;  // the inside corners first
    const auto outside = std::stable_partition(sorted.begin(), sorted.end(), [&](int p) { return is_inside(p); });
    const auto [a, b, c, d] = sorted;
    switch (outside - sorted.begin()) {
      case 1:
        return add_triangle(crossing(a, b), crossing(a, c), crossing(a, d), a);
      case 2:
        add_triangle(crossing(a, c), crossing(a, d), crossing(b, c), a);
        return add_triangle(crossing(b, c), crossing(a, d), crossing(b, d), b);
      case 3:
        return add_triangle(crossing(a, d), crossing(b, d), crossing(c, d), a);
      default:
        return;
    }
  }

  IndexedTriangles take_result() { return std::move(result_); }

 private:
  bool is_inside(int grid_point) const { return grid_.value(grid_point) < 0; }

  std::int32_t crossing(int inside, int outside) {
    const auto key = static_cast<std::uint64_t>(std::min(inside, outside)) << 32 |
                     static_cast<std::uint64_t>(std::max(inside, outside));
    const auto [entry, is_new] = crossings_.try_emplace(key, static_cast<std::int32_t>(result_.vertices.size()));
    if (is_new) {
      // Kept off the ends, where the crossings of several edges would fall together.
      const double share = grid_.value(inside) / (grid_.value(inside) - grid_.value(outside));
      const Vector from = grid_.point(inside), to = grid_.point(outside);
      result_.vertices.push_back(from + std::clamp(share, 0.1, 0.9) * (to - from));
    }
    return entry->second;
  }

  void add_triangle(std::int32_t a, std::int32_t b, std::int32_t c, int inside) {
    const Vector& corner = result_.vertices[a];
    const Vector normal = (result_.vertices[b] - corner).cross(result_.vertices[c] - corner);
    const bool faces_outwards = normal.dot(corner - grid_.point(inside)) > 0;
    result_.triangles.push_back(faces_outwards ? Triangle{a, b, c} : Triangle{a, c, b});
  }

  const Grid& grid_;
  std::unordered_map<std::uint64_t, std::int32_t> crossings_;
  IndexedTriangles result_;
};

// The six tetrahedra round the main diagonal of a cube; corner bits are the steps along x, y, z. Adjacent cubes agree
// on the diagonals of their common face.
constexpr std::array<std::array<int, 4>, 6> cube_tetrahedra{
    {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}};

}  // namespace

IndexedTriangles extract_isosurface(const ImplicitSurface& surface, double cell_size) {
  const Grid grid(surface, cell_size);
  TetrahedronMarcher marcher(grid);
  const auto [nx, ny, nz] = grid.cell_counts();
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        for (const auto& tetrahedron : cube_tetrahedra) {
          std::array<int, 4> corners;
          for (int c = 0; c < 4; ++c)
            corners[c] = grid.index(i + (tetrahedron[c] & 1), j + (tetrahedron[c] >> 1 & 1), k + (tetrahedron[c] >> 2));
          marcher.march(corners);
        }
  return marcher.take_result();
}

}  // namespace pectinate::detail
