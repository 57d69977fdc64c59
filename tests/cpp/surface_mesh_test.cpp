// SPDX-License-Identifier: MIT
#include "pectinate/surface_mesh.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>

#include "pectinate/errors.hpp"
#include "surface_checks.hpp"

namespace pectinate::test {
namespace {

void check_untouched(const SurfaceMesh& mesh) {
  const auto& repairs = mesh.repairs();
  CHECK(repairs.degenerate_triangles.empty());
  CHECK(repairs.duplicate_triangles.empty());
  CHECK(repairs.non_finite_vertices.empty());
  CHECK(repairs.non_finite_triangles.empty());
  CHECK(repairs.unreferenced_vertices.empty());
  CHECK(repairs.reversed_triangles.empty());
  CHECK(repairs.non_manifold_edges.empty());
  CHECK(repairs.split_vertices.empty());
}

/// Triangles in any order, about a third of them reversed.
Soup tumbled(Soup soup, std::uint64_t seed) {
  Random random(seed);
  soup.triangles = shuffled(std::move(soup.triangles), random);
  for (auto& triangle : soup.triangles) {
    if (random.below(3) == 0) std::swap(triangle[0], triangle[1]);
  }
  return soup;
}

struct Known {
  const char* name;
  Soup soup;
  int euler_characteristic, boundary_loop_count, genus;
  bool orientable;
};

std::vector<Known> known_surfaces() {
  return {{"sphere", sphere(2), 2, 0, 0, true},
          {"tetrahedron", tetrahedron(), 2, 0, 0, true},
          {"torus", torus(9, 5), 0, 0, 1, true},
          {"cylinder", cylinder(7, 3, 1, 2), 0, 2, 0, true},
          {"rectangle", jittered_grid(5, 4), 1, 1, 0, true},
          {"triangle", one_triangle(), 1, 1, 0, true},
          {"Moebius strip", moebius_strip(9, 2), 0, 1, 1, false},
          {"Klein bottle", klein_bottle(11, 7), 0, 0, 2, false}};
}

}  // namespace

TEST_CASE("mesh: known surfaces keep their topology whatever the windings and the order of their triangles") {
  for (const auto& [name, soup, euler_characteristic, boundary_loop_count, genus, orientable] : known_surfaces()) {
    CAPTURE(name);
    for (const std::uint64_t seed : {0, 1, 2}) {
      const auto mesh = checked(seed == 0 ? soup : tumbled(soup, seed));
      REQUIRE(mesh.components().size() == 1);
      const auto& component = mesh.components()[0];
      CHECK(component.euler_characteristic == euler_characteristic);
      CHECK(component.boundary_loop_count == boundary_loop_count);
      CHECK(component.genus == genus);
      CHECK(component.orientable == orientable);
      CHECK(mesh.repairs().non_manifold_edges.empty());
      CHECK(mesh.repairs().split_vertices.empty());
    }
    if (orientable) check_untouched(checked(soup));
  }
}

TEST_CASE("mesh: closed and open surfaces alike face outwards") {
  auto hemisphere = sphere(2);
  std::erase_if(hemisphere.triangles, [&](const Triangle& t) {
    return hemisphere.vertices[t[0]][2] + hemisphere.vertices[t[1]][2] + hemisphere.vertices[t[2]][2] < 0;
  });
  Soup pyramid{{{0, 0, 1}, {1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}},
               {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}}};
  for (const auto& soup : {sphere(2), torus(9, 5), tetrahedron(), cylinder(12, 3, 1, 2), hemisphere, pyramid}) {
    const auto expected = soup.mesh();
    for (const std::uint64_t seed : {1, 2, 3}) {
      auto input = tumbled(soup, seed);
      CHECK(signed_volume(checked(input)) == doctest::Approx(signed_volume(expected)).epsilon(1e-12));
      for (auto& triangle : input.triangles) std::swap(triangle[1], triangle[2]);  // now most face inwards
      CHECK(signed_volume(checked(input)) == doctest::Approx(signed_volume(expected)).epsilon(1e-12));
    }
    CHECK(signed_volume(expected) > 0);
  }
}

TEST_CASE("mesh: of components whose triangles lie mixed each faces outwards") {
  const std::vector<Soup> parts = {sphere(2), moved(torus(9, 5), {20, 0, 0}), moved(cylinder(12, 3, 1, 2), {40, 0, 0}),
                                   moved(tetrahedron(), {60, 0, 0})};
  Soup all;
  double volume = 0, area = 0;
  for (auto part : parts) {
    const auto mesh = part.mesh();
    volume += signed_volume(mesh);
    area += mesh.area();
    for (auto& triangle : part.triangles) std::swap(triangle[1], triangle[2]);
    all = together(all, part);
  }
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto mesh = checked(tumbled(all, seed));
    REQUIRE(mesh.components().size() == parts.size());
    CHECK(signed_volume(mesh) == doctest::Approx(volume).epsilon(1e-12));
    CHECK(mesh.area() == doctest::Approx(area).epsilon(1e-12));
  }
}

TEST_CASE("mesh: a flat surface follows the majority of its windings") {
  auto soup = grid(6, 5);
  Random random(7);
  std::set<std::int32_t> minority;
  while (minority.size() < soup.triangles.size() / 2 - 1) {
    minority.insert(static_cast<std::int32_t>(random.below(soup.triangles.size())));
  }
  for (const auto t : minority) std::swap(soup.triangles[t][0], soup.triangles[t][2]);
  const auto mesh = checked(soup);
  CHECK(mesh.repairs().reversed_triangles == Indices(minority.begin(), minority.end()));
  for (const auto& normal : mesh.triangle_normals()) CHECK(normal == Vec3{0, 0, 1});
}

TEST_CASE("mesh: areas, normals and the boundary are those of the shape") {
  const auto mesh = checked(jittered_grid(5, 4, 0.5));
  CHECK(mesh.area() == doctest::Approx(2.5 * 2.0).epsilon(1e-14));
  CHECK(mesh.bounding_box_diagonal() == doctest::Approx(std::hypot(2.5, 2.0)).epsilon(1e-14));
  REQUIRE(mesh.boundary_loops().size() == 1);
  const auto& loop = mesh.boundary_loops()[0];
  CHECK(loop.length == doctest::Approx(9).epsilon(1e-14));
  CHECK(loop.diameter == doctest::Approx(std::hypot(2.5, 2.0)).epsilon(1e-14));
  CHECK(loop.centroid[0] == doctest::Approx(1.25).epsilon(1e-14));
  CHECK(loop.centroid[1] == doctest::Approx(1).epsilon(1e-14));
  CHECK(loop.vertices.size() == 18);
}

TEST_CASE("mesh: each kind of repair is made and reported with the input's indices") {
  Soup soup = grid(2, 1);                                                    // vertices 0 to 5, triangles 0 to 3
  soup.vertices.push_back({nan, 0, 0});                                      // 6
  soup.vertices.push_back({9, 9, 9});                                        // 7: nothing uses it
  soup.vertices.push_back({2, 0, 0});                                        // 8: on the line through 0 and 1
  soup.vertices.push_back({0, 0, std::numeric_limits<double>::infinity()});  // 9: nothing uses it
  soup.triangles.insert(soup.triangles.begin(), {1, 1, 2});
  soup.triangles.push_back({0, 1, 6});
  soup.triangles.push_back({1, 4, 0});  // the corners of the first valid one, turned
  soup.triangles.push_back({0, 1, 8});
  const auto mesh = checked(soup);
  CHECK(mesh.repairs().degenerate_triangles == Indices{0, 7});
  CHECK(mesh.repairs().non_finite_triangles == Indices{5});
  CHECK(mesh.repairs().duplicate_triangles == Indices{6});
  CHECK(mesh.repairs().non_finite_vertices == Indices{6, 9});
  CHECK(mesh.repairs().unreferenced_vertices == Indices{7, 8});
  CHECK(mesh.input_triangle() == Indices{1, 2, 3, 4});
}

TEST_CASE("mesh: an edge of three triangles is cut, but stays one edge") {
  const auto mesh = checked(three_on_an_edge());
  CHECK(mesh.triangle_count() == 3);
  CHECK(mesh.components().size() == 3);
  CHECK(mesh.repairs().non_manifold_edges == std::vector<Pair>{{0, 1}});
  CHECK(mesh.repairs().split_vertices == Indices{0, 1, 0, 1});
  CHECK(mesh.edges().size() == 7);
  const auto shared = mesh.triangle_edges()[0][0];
  CHECK(mesh.edge_triangles(shared).size() == 3);
}

TEST_CASE("mesh: a bow tie is split at its knot") {
  const auto mesh = checked(bow_tie());
  CHECK(mesh.components().size() == 2);
  CHECK(mesh.boundary_loops().size() == 2);
  CHECK(mesh.repairs().split_vertices == Indices{0});
  CHECK(mesh.repairs().non_manifold_edges.empty());
}

TEST_CASE("mesh: two closed shells that touch along an edge stay closed") {
  auto soup = tetrahedron();
  // A second tetrahedron over the edge from vertex 0 to vertex 3, on the other side.
  soup.vertices.insert(soup.vertices.end(), {{-1, 0, 0}, {0, -1, 0}});
  soup.triangles.insert(soup.triangles.end(), {{0, 4, 5}, {0, 3, 4}, {3, 5, 4}, {0, 5, 3}});
  const auto mesh = checked(soup);
  CHECK(mesh.repairs().non_manifold_edges == std::vector<Pair>{{0, 3}});
  REQUIRE(mesh.components().size() == 2);
  for (const auto& component : mesh.components()) CHECK(component.euler_characteristic == 2);
  CHECK(mesh.boundary_loops().empty());
}

TEST_CASE("mesh: closed shells that touch at a vertex, or touch a border there, are parted") {
  // Fans of three and three triangles, of three and four, and of three closed ones beside an open one.
  const Soup shells[] = {tetrahedron(), sphere(0), jittered_grid(2, 2)};
  for (const auto& other : shells) {
    auto soup = together(tetrahedron(), moved(other, {5, 0, 0}));
    const auto knot = soup.triangles.back()[0];
    for (auto& triangle : soup.triangles) std::ranges::replace(triangle, knot, 0);
    const auto mesh = checked(soup);
    CHECK(mesh.components().size() == 2);
    CHECK(mesh.components()[0].euler_characteristic == 2);
    CHECK(mesh.repairs().split_vertices == Indices{0});
    CHECK(mesh.repairs().unreferenced_vertices == Indices{knot});
  }
}

TEST_CASE("mesh: exact repetitions are found where edges join two triangles, and where they join more") {
  for (auto soup : {one_triangle(), three_on_an_edge(), sphere(1), moebius_strip(7, 1)}) {
    const auto once = checked(soup);
    const auto count = soup.triangles.size();
    Indices repeated;
    for (std::size_t t = 0; t < count; t += 2) {
      const auto [a, b, c] = soup.triangles[t];
      repeated.push_back(static_cast<std::int32_t>(soup.triangles.size()));
      soup.triangles.push_back(t % 4 == 0 ? Triangle{b, c, a} : Triangle{a, c, b});
    }
    const auto mesh = checked(soup);
    CHECK(mesh.repairs().duplicate_triangles == repeated);
    CHECK(mesh.triangles() == once.triangles());
    CHECK(mesh.repairs().reversed_triangles == once.repairs().reversed_triangles);
  }
}

TEST_CASE("mesh: a Moebius strip's border belongs to it, wherever its seam begins") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto mesh = checked(tumbled(moebius_strip(5, 1), seed));
    REQUIRE(mesh.boundary_loops().size() == 1);
    CHECK(mesh.boundary_loops()[0].component == 0);
    CHECK(mesh.components()[0].boundary_loop_count == 1);
  }
}

TEST_CASE("mesh: vertices of few and of many triangles are joined alike") {
  for (const bool is_apex_first : {true, false}) {
    for (std::int32_t count = 3; count <= 40; ++count) {
      CAPTURE(count);
      const std::int32_t apex = is_apex_first ? 0 : count, first = is_apex_first ? 1 : 0;
      Soup cone;
      cone.vertices.resize(count + 1, {0, 0, 1});
      for (std::int32_t i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * i / count;
        cone.vertices[first + i] = {std::cos(angle), std::sin(angle), 0};
        cone.triangles.push_back({apex, first + i, first + (i + 1) % count});
      }
      for (const auto& soup : {cone, tumbled(cone, count)}) {
        const auto mesh = checked(soup);
        CHECK(mesh.edges().size() == 2 * static_cast<std::size_t>(count));
        REQUIRE(mesh.boundary_loops().size() == 1);
        CHECK(mesh.boundary_loops()[0].vertices.size() == static_cast<std::size_t>(count));
      }
    }
  }
}

TEST_CASE("mesh: of any number of vertices that nothing uses") {
  for (const std::size_t count : {1, 2000, 3000000}) {
    auto soup = one_triangle();
    const auto used = soup.vertices.size();
    soup.vertices.resize(used + count, {7, 8, 9});
    const auto mesh = soup.mesh();
    CHECK(mesh.vertices().size() == used);
    CHECK(mesh.repairs().unreferenced_vertices.size() == count);
    CHECK(mesh.area() == one_triangle().mesh().area());
  }
}

TEST_CASE("mesh: components are told apart and measured one by one") {
  const auto mesh = checked(together(sphere(1), moved(torus(8, 6), {9, 0, 0})));
  REQUIRE(mesh.components().size() == 2);
  CHECK(mesh.components()[0].genus == 0);
  CHECK(mesh.components()[1].genus == 1);
  CHECK(mesh.components()[0].area == doctest::Approx(sphere(1).mesh().area()).epsilon(1e-12));
  CHECK(mesh.components()[1].area == doctest::Approx(torus(8, 6).mesh().area()).epsilon(1e-12));
}

TEST_CASE("mesh: random soups are repaired, or refused as invalid") {
  Random random(3);
  int refused = 0;
  for (int round = 0; round < 600; ++round) {
    CAPTURE(round);
    Soup soup;
    const auto vertex_count = 3 + random.below(8);
    for (std::uint64_t v = 0; v < vertex_count; ++v) {
      soup.vertices.push_back({random.unit(), random.unit(), random.below(20) == 0 ? nan : random.unit()});
    }
    for (auto count = 1 + random.below(40); count > 0; --count) {
      const auto draw = [&] { return static_cast<std::int32_t>(random.below(vertex_count)); };
      soup.triangles.push_back({draw(), draw(), draw()});
    }
    std::set<Triangle> valid;
    for (const auto& t : soup.triangles) {
      const bool distinct = t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
      const auto finite = [&](auto v) { return !std::isnan(soup.vertices[v][2]); };
      if (distinct && std::all_of(t.begin(), t.end(), finite)) valid.insert(sorted(t));
    }
    if (valid.empty()) {
      CHECK_THROWS_AS(soup.mesh(), InvalidMesh);
      ++refused;
    } else {
      CHECK(checked(soup).triangle_count() == valid.size());
    }
  }
  CHECK(refused > 0);
  CHECK(refused < 60);
}

TEST_CASE("mesh: what is no surface is refused") {
  const auto refused = [](std::vector<Vec3> vertices, std::vector<Triangle> triangles) {
    CHECK_THROWS_AS(SurfaceMesh(vertices, triangles), InvalidMesh);
  };
  const auto corners = one_triangle().vertices;
  refused({}, {});
  refused(corners, {});
  refused({}, {{0, 1, 2}});
  refused(corners, {{0, 1, 3}});
  refused(corners, {{0, -1, 2}});
  refused(corners, {{0, 1, 2}, {0, 1, std::numeric_limits<std::int32_t>::max()}});
  refused(corners, {{0, 1, 1}});
  refused({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}});
  refused({{nan, 0, 0}, {nan, 0, 0}, {nan, 1, 0}}, {{0, 1, 2}});
  // Areas that are not finite, or vanish.
  for (const double size : {1e-200, 1e-100, 1e80, 1e100, 1e160, 1e300}) {
    refused({{size, 0, 0}, {0, size, 0}, {0, 0, 0}}, {{0, 1, 2}});
  }
}

TEST_CASE("mesh: a message names the triangle, the vertex and the remedy") {
  const auto soup = one_triangle();
  const std::vector<Triangle> triangles{{0, 1, 2}, {1, 2, 77}};
  try {
    const SurfaceMesh mesh(soup.vertices, triangles);
    FAIL("accepted");
  } catch (const InvalidMesh& error) {
    const std::string message = error.what();
    for (const char* part : {"triangle 1", "vertex 77", "correct the index"}) {
      CHECK(message.find(part) != std::string::npos);
    }
  }
}

}  // namespace pectinate::test
