// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "detail/random.hpp"
#include "detail/vec.hpp"
#include "pectinate/surface_mesh.hpp"

/// Makers of small surfaces with known properties.
namespace pectinate::test {

struct Soup {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;

  SurfaceMesh mesh() const { return SurfaceMesh(vertices, triangles); }
};

/// Two triangles for every square of a chart of columns x rows squares; `index(i, j)` numbers its corners.
template <class Index>
std::vector<Triangle> chart_triangles(int columns, int rows, const Index& index) {
  std::vector<Triangle> triangles;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const std::int32_t a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1), d = index(i, j + 1);
      triangles.push_back({a, b, c});
      triangles.push_back({a, c, d});
    }
  }
  return triangles;
}

/// The rectangle [0, columns spacing] x [0, rows spacing] of the plane z = 0, facing +z.
inline Soup grid(int columns, int rows, double spacing = 1) {
  Soup soup;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) soup.vertices.push_back({i * spacing, j * spacing, 0});
  }
  soup.triangles = chart_triangles(columns, rows, [&](int i, int j) { return i + (columns + 1) * j; });
  return soup;
}

/// The same rectangle, its inner vertices moved by up to 0.3 spacing: no two edges are parallel.
inline Soup jittered_grid(int columns, int rows, double spacing = 1, std::uint64_t seed = 1) {
  Soup soup = grid(columns, rows, spacing);
  Random random(seed);
  for (int j = 1; j < rows; ++j) {
    for (int i = 1; i < columns; ++i) {
      auto& vertex = soup.vertices[i + (columns + 1) * j];
      vertex[0] += 0.3 * spacing * (2 * random.unit() - 1);
      vertex[1] += 0.3 * spacing * (2 * random.unit() - 1);
    }
  }
  return soup;
}

/// A tetrahedron with outward normals.
inline Soup tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

/// A sphere of 8 x 4^subdivisions triangles with outward normals.
inline Soup sphere(int subdivisions, double radius = 1) {
  Soup soup{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
            {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (int s = 0; s < subdivisions; ++s) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [place, is_new] = middles.try_emplace(std::minmax(a, b), soup.vertices.size());
      if (is_new) {
        soup.vertices.push_back(
            detail::vec3((detail::vector(soup.vertices[a]) + detail::vector(soup.vertices[b])).normalized()));
      }
      return place->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : soup.triangles) {
      const std::int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    soup.triangles = std::move(finer);
  }
  for (auto& vertex : soup.vertices) vertex = detail::vec3(radius * detail::vector(vertex));
  return soup;
}

inline double turn(int i, int count) {
  return 2 * std::numbers::pi * i / count;
}

/// Outward normals.
inline Soup torus(int around, int across, double radius = 2, double tube = 0.7) {
  Soup soup;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = turn(i, around), v = turn(j, across), ring = radius + tube * std::cos(v);
      soup.vertices.push_back({ring * std::cos(u), ring * std::sin(u), tube * std::sin(v)});
    }
  }
  soup.triangles = chart_triangles(around, across, [=](int i, int j) { return across * (i % around) + j % across; });
  return soup;
}

/// An open prism around the z axis from 0 to `height`; outward normals.
inline Soup cylinder(int around, int rows, double radius, double height) {
  Soup soup;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i < around; ++i) {
      soup.vertices.push_back(
          {radius * std::cos(turn(i, around)), radius * std::sin(turn(i, around)), height * j / rows});
    }
  }
  soup.triangles = chart_triangles(around, rows, [=](int i, int j) { return i % around + around * j; });
  return soup;
}

/// A flat ring around the origin, facing +z; loop of radius `outer` first in length.
inline Soup annulus(int around, int rows, double inner, double outer) {
  Soup soup;
  for (int j = 0; j <= rows; ++j) {
    const double radius = inner + (outer - inner) * j / rows;
    for (int i = 0; i < around; ++i) {
      soup.vertices.push_back({radius * std::cos(turn(i, around)), radius * std::sin(turn(i, around)), 0});
    }
  }
  soup.triangles =
      chart_triangles(around, rows, [=](int i, int j) { return (around - i % around) % around + around * j; });
  return soup;
}

/// A strip with half a twist around a circle; vertex i * (rows + 1) + j is `j` rows across it.
inline Soup moebius_strip(int around, int rows, double radius = 2, double width = 1) {
  Soup soup;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j <= rows; ++j) {
      const double u = turn(i, around), offset = width * (static_cast<double>(j) / rows - 0.5);
      const double ring = radius + offset * std::cos(u / 2);
      soup.vertices.push_back({ring * std::cos(u), ring * std::sin(u), offset * std::sin(u / 2)});
    }
  }
  soup.triangles =
      chart_triangles(around, rows, [=](int i, int j) { return i < around ? i * (rows + 1) + j : rows - j; });
  return soup;
}

/// A closed surface that has no inside, immersed as a figure of eight.
inline Soup klein_bottle(int around, int across) {
  Soup soup;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = turn(i, around), v = turn(j, across);
      const double ring = 3 + std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v);
      soup.vertices.push_back(
          {ring * std::cos(u), ring * std::sin(u), std::sin(u / 2) * std::sin(v) + std::cos(u / 2) * std::sin(2 * v)});
    }
  }
  soup.triangles = chart_triangles(around, across, [=](int i, int j) {
    return i < around ? across * i + j % across : (across - j % across) % across;
  });
  return soup;
}

/// Three triangles around one edge, from vertex 0 to vertex 1.
inline Soup three_on_an_edge() {
  return {{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-0.5, 0.8, 0}, {-0.5, -0.8, 0}}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
}

/// Two triangles that share vertex 0 only.
inline Soup bow_tie() {
  return {{{0, 0, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}};
}

inline Soup one_triangle() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
}

/// Both, not joined.
inline Soup together(Soup first, const Soup& second) {
  const auto shift = static_cast<std::int32_t>(first.vertices.size());
  first.vertices.insert(first.vertices.end(), second.vertices.begin(), second.vertices.end());
  for (const auto& [a, b, c] : second.triangles) first.triangles.push_back({a + shift, b + shift, c + shift});
  return first;
}

template <class Map>
Soup mapped(Soup soup, const Map& map) {
  for (auto& vertex : soup.vertices) vertex = detail::vec3(map(detail::Vector(detail::vector(vertex))));
  return soup;
}

inline Soup moved(Soup soup, const Vec3& offset) {
  return mapped(std::move(soup), [&](const detail::Vector& v) { return detail::Vector(v + detail::vector(offset)); });
}

/// The items in an order drawn at random.
template <class Item>
std::vector<Item> shuffled(std::vector<Item> items, Random& random) {
  for (std::size_t n = items.size(); n > 1; --n) std::swap(items[n - 1], items[random.below(n)]);
  return items;
}

}  // namespace pectinate::test
