// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <set>
#include <vector>

#include "meshes.hpp"

/// Makers of surfaces that can be mapped to a disk.
namespace pectinate::test {

/// The unit disk in the plane z = 0, facing +z: rings of 6, 12, ... vertices. Those of the border come first, evenly
/// spaced from (1, 0) on; the centre comes last.
inline Soup hexagonal_disk(int rings) {
  Soup soup;
  std::vector<std::int32_t> first(rings + 1);
  for (int ring = rings; ring > 0; --ring) {
    first[ring] = static_cast<std::int32_t>(soup.vertices.size());
    const double radius = static_cast<double>(ring) / rings;
    for (int i = 0; i < 6 * ring; ++i) {
      soup.vertices.push_back({radius * std::cos(turn(i, 6 * ring)), radius * std::sin(turn(i, 6 * ring)), 0});
    }
  }
  first[0] = static_cast<std::int32_t>(soup.vertices.size());
  soup.vertices.push_back({0, 0, 0});
  const auto at = [&](int ring, int i) { return ring == 0 ? first[0] : first[ring] + i % (6 * ring); };
  for (int ring = 1; ring <= rings; ++ring) {
    for (int sector = 0; sector < 6; ++sector) {
      for (int i = 0; i < ring; ++i) {
        const int outer = sector * ring + i, inner = sector * (ring - 1) + i;
        soup.triangles.push_back({at(ring, outer), at(ring, outer + 1), at(ring - 1, inner)});
        if (i < ring - 1) {
          soup.triangles.push_back({at(ring - 1, inner), at(ring, outer + 1), at(ring - 1, inner + 1)});
        }
      }
    }
  }
  return soup;
}

/// Two such disks, mirror images that share one border edge.
inline Soup twin_disks(int rings) {
  Soup soup = hexagonal_disk(rings);
  const detail::Vector a = detail::vector(soup.vertices[0]), b = detail::vector(soup.vertices[1]);
  const detail::Vector across = (b - a).cross(detail::Vector::UnitZ()).normalized();
  const auto count = static_cast<std::int32_t>(soup.vertices.size());
  for (std::int32_t v = 2; v < count; ++v) {
    const detail::Vector original = detail::vector(soup.vertices[v]);
    soup.vertices.push_back(detail::vec3(original - 2 * (original - a).dot(across) * across));
  }
  const auto twin = [&](std::int32_t v) { return v < 2 ? v : v + count - 2; };
  for (const auto triangles = soup.triangles; const auto& [p, q, r] : triangles) {
    soup.triangles.push_back({twin(p), twin(r), twin(q)});
  }
  return soup;
}

/// The unit disk again, its inner vertices moved by up to 0.2 of the rings' distance.
inline Soup jittered_disk(int rings, std::uint64_t seed) {
  Soup soup = hexagonal_disk(rings);
  Random random(seed);
  for (std::size_t v = 6 * rings; v < soup.vertices.size(); ++v) {
    for (int k = 0; k < 2; ++k) soup.vertices[v][k] += 0.2 / rings * (2 * random.unit() - 1);
  }
  return soup;
}

/// Without the triangles around some inner vertices: `count` holes (fewer if there is no room) that share no vertex
/// with one another or the border.
inline Soup with_holes(Soup soup, std::size_t border_size, int count, std::uint64_t seed) {
  Random random(seed);
  std::set<std::int32_t> taken;
  for (std::size_t v = 0; v < border_size; ++v) taken.insert(static_cast<std::int32_t>(v));
  for (int attempt = 0; attempt < 50 && count > 0; ++attempt) {
    const auto hole = static_cast<std::int32_t>(random.below(soup.vertices.size()));
    std::vector<Triangle> kept;
    std::set<std::int32_t> around;
    for (const auto& corners : soup.triangles) {
      if (std::find(corners.begin(), corners.end(), hole) == corners.end()) {
        kept.push_back(corners);
      } else {
        around.insert(corners.begin(), corners.end());
      }
    }
    if (around.empty() || std::any_of(around.begin(), around.end(), [&](auto v) { return taken.contains(v); }))
      continue;
    taken.insert(around.begin(), around.end());
    soup.triangles = std::move(kept);
    --count;
  }
  return soup;
}

/// A dome with bumps of several sizes, some as high as they are wide many times over.
inline Soup bumpy_disk(int rings, std::uint64_t seed) {
  Random random(seed);
  struct Bump {
    double x, y, width, height;
  };
  std::vector<Bump> bumps;
  for (int i = 0; i < 5; ++i) {
    const double x = 1.2 * random.unit() - 0.6, y = 1.2 * random.unit() - 0.6, width = 0.1 + 0.2 * random.unit();
    bumps.push_back({x, y, width, 0.6 * (2 * random.unit() - 1)});
  }
  return mapped(jittered_disk(rings, seed), [&](detail::Vector v) {
    double height = 1 - v.x() * v.x() - v.y() * v.y();
    for (const auto& [x, y, width, peak] : bumps) {
      height += peak * std::exp(-(std::pow(v.x() - x, 2) + std::pow(v.y() - y, 2)) / (width * width));
    }
    v.z() = height;
    return v;
  });
}

/// The ring between the unit circle and the circle of radius exp(-pi / (2 sqrt 3)) = 0.40, of nearly equilateral
/// triangles; `around` is a multiple of 6. The outer border comes first, from (1, 0) on; rows are staggered.
inline Soup equilateral_annulus(int around) {
  Soup soup;
  const int rows = around / 6;
  for (int j = 0; j <= rows; ++j) {
    const double radius = std::exp(-std::sqrt(3) * std::numbers::pi * j / around);
    for (int i = 0; i < around; ++i) {
      const double angle = turn(i, around) + turn(j % 2, 2 * around);
      soup.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < around; ++i) {
      const auto outer = [&](int k) { return j * around + (i + k) % around; };
      const auto inner = [&](int k) { return (j + 1) * around + (i + k) % around; };
      if (j % 2 == 0) {
        soup.triangles.insert(soup.triangles.end(), {{outer(0), outer(1), inner(0)}, {inner(0), outer(1), inner(1)}});
      } else {
        soup.triangles.insert(soup.triangles.end(), {{outer(0), outer(1), inner(1)}, {inner(0), outer(0), inner(1)}});
      }
    }
  }
  return soup;
}

}  // namespace pectinate::test
