// SPDX-License-Identifier: MIT
#include "detail/critical_points.hpp"

#include <doctest/doctest.h>

#include <complex>

#include "disks.hpp"
#include "meshes.hpp"

namespace pectinate::test {
namespace {

using detail::Vector;

/// The values of a function of x + i y at the vertices of a flat mesh.
template <class Function>
std::vector<double> values_of(const Soup& soup, const Function& function) {
  std::vector<double> values;
  for (const auto& [x, y, z] : soup.vertices) values.push_back(function(std::complex<double>(x, y)));
  return values;
}

}  // namespace

TEST_CASE("critical points: those of polynomials") {
  const auto disk = hexagonal_disk(6);
  const auto centre = static_cast<std::int32_t>(disk.vertices.size()) - 1;
  std::vector<bool> border(disk.vertices.size(), false);
  std::fill_n(border.begin(), 36, true);
  const auto found = [&](const auto& function) {
    return detail::critical_points(disk.triangles, values_of(disk, function), border);
  };
  using Complex = std::complex<double>;
  const auto check_centre = [&](const std::vector<CriticalPoint>& points, int index) {
    REQUIRE(points.size() == 1);
    CHECK(points[0].vertex == centre);
    CHECK(points[0].index == index);
  };
  const Complex turned = std::polar(1.0, 0.1);
  check_centre(found([](Complex z) { return std::norm(z); }), 1);
  check_centre(found([](Complex z) { return -std::norm(z); }), 1);
  check_centre(found([&](Complex z) { return (turned * z * z).real(); }), -1);
  check_centre(found([&](Complex z) { return (turned * z * z * z).real(); }), -2);
  CHECK(found([&](Complex z) { return (turned * z).real(); }).empty());
  CHECK(found([](Complex z) { return z.real(); }).empty());
  CHECK(found([](Complex) { return 0.5; }).empty());
  CHECK(found([](Complex z) { return std::max(z.real(), 0.0); }).empty());
}

TEST_CASE("critical points: indices add up to the Euler characteristic") {
  const auto soup = sphere(3);
  for (const std::uint64_t seed : {1, 2, 3}) {
    Random random(seed);
    std::vector<double> values;
    for (std::size_t v = 0; v < soup.vertices.size(); ++v) values.push_back(random.unit());
    int sum = 0;
    const std::vector<bool> none(values.size(), false);
    for (const auto& point : detail::critical_points(soup.triangles, values, none)) sum += point.index;
    CHECK(sum == 2);
  }
}

}  // namespace pectinate::test
