// SPDX-License-Identifier: MIT
#include "detail/frontal_cholesky.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cstdlib>
#include <set>

#include "detail/elimination_tree.hpp"
#include "detail/random.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::test {
namespace {

using detail::FrontalCholesky;
using detail::HermitianMatrix;
using Complex = std::complex<double>;
using Edges = std::vector<FrontalCholesky::Edge>;

/// A square grid with a few long edges.
Edges some_graph(std::int32_t columns, std::int32_t rows, Random& random) {
  std::set<std::pair<std::int32_t, std::int32_t>> edges;
  for (std::int32_t j = 0; j < rows; ++j) {
    for (std::int32_t i = 0; i < columns; ++i) {
      const std::int32_t node = i + columns * j;
      if (i + 1 < columns) edges.emplace(node, node + 1);
      if (j + 1 < rows) edges.emplace(node, node + columns);
    }
  }
  for (int k = 0; k < 5; ++k) {
    const auto a = static_cast<std::int32_t>(random.below(columns * rows));
    const auto b = static_cast<std::int32_t>(random.below(columns * rows));
    if (a < b) edges.emplace(a, b);
  }
  Edges list;
  for (const auto& [a, b] : edges) {
    if (random.below(2) == 0) {
      list.push_back({a, b});
    } else {
      list.push_back({b, a});
    }
  }
  return list;
}

/// Positive definite, because its diagonal dominates.
HermitianMatrix some_matrix(std::int32_t nodes, const Edges& edges, Random& random) {
  HermitianMatrix matrix{std::vector<double>(nodes, 0.1), {}};
  for (const auto& [a, b] : edges) {
    matrix.edges.emplace_back(random.unit() - 0.5, random.unit() - 0.5);
    matrix.diagonal[a] += std::abs(matrix.edges.back());
    matrix.diagonal[b] += std::abs(matrix.edges.back());
  }
  return matrix;
}

Eigen::MatrixXcd dense(const HermitianMatrix& matrix, const Edges& edges) {
  const auto count = static_cast<Eigen::Index>(matrix.diagonal.size());
  Eigen::MatrixXcd full = Eigen::MatrixXcd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) full(i, i) = matrix.diagonal[i];
  for (std::size_t e = 0; e < edges.size(); ++e) {
    full(edges[e][1], edges[e][0]) = matrix.edges[e];
    full(edges[e][0], edges[e][1]) = std::conj(matrix.edges[e]);
  }
  return full;
}

Eigen::VectorXcd some_vector(std::int32_t count, Random& random) {
  Eigen::VectorXcd v(count);
  for (auto& x : v) x = {random.unit() - 0.5, random.unit() - 0.5};
  return v;
}

}  // namespace

TEST_CASE("the frontal solution is that of a dense factorization") {
  Random random(1);
  for (const auto& [columns, rows] : {std::pair{1, 1}, {2, 1}, {5, 1}, {7, 6}, {23, 17}}) {
    const std::int32_t count = columns * rows;
    const Edges edges = some_graph(columns, rows, random);
    const HermitianMatrix matrix = some_matrix(count, edges, random);
    const Eigen::VectorXcd b = some_vector(count, random);
    FrontalCholesky cholesky(count, edges);
    cholesky.eliminate(matrix, b);
    const Eigen::VectorXcd expected = dense(matrix, edges).ldlt().solve(b);
    CHECK((cholesky.solution() - expected).norm() <= 1e-12 * expected.norm());
    const Eigen::VectorXcd other = some_vector(count, random);
    cholesky.replace(other);
    CHECK((dense(matrix, edges) * cholesky.solution() - other).norm() <= 1e-12 * other.norm());
  }
}

TEST_CASE("the order of elimination does not depend on the C library's random numbers") {
  Random random(5);
  const Edges edges = some_graph(60, 50, random);
  const auto expected = detail::make_elimination_tree(3000, edges);
  for (const unsigned seed : {0U, 1U, 4321U, 123456789U}) {
    std::srand(seed);
    for (unsigned draw = 0; draw < seed % 7; ++draw) static_cast<void>(std::rand());
    const auto tree = detail::make_elimination_tree(3000, edges);
    CHECK(tree.order == expected.order);
    CHECK(tree.parent == expected.parent);
  }
}

TEST_CASE("a graph without edges and one of several parts are solved") {
  Random random(2);
  const Edges edges{{0, 1}, {3, 2}, {5, 4}};
  for (const Edges& some : {Edges{}, edges}) {
    const HermitianMatrix matrix = some_matrix(7, some, random);
    const Eigen::VectorXcd b = some_vector(7, random);
    FrontalCholesky cholesky(7, some);
    cholesky.eliminate(matrix, b);
    CHECK((dense(matrix, some) * cholesky.solution() - b).norm() <= 1e-13);
  }
}

TEST_CASE("eliminating what changed gives the bytes of a fresh start") {
  Random random(3);
  const Edges edges = some_graph(41, 33, random);
  const std::int32_t count = 41 * 33;
  HermitianMatrix matrix = some_matrix(count, edges, random);
  Eigen::VectorXcd b = some_vector(count, random);
  FrontalCholesky edited(count, edges);
  edited.eliminate(matrix, b);
  for (int step = 0; step < 20; ++step) {
    std::set<std::int32_t> changed;
    for (int k = 0; k < 1 + step % 4; ++k) {
      const auto e = random.below(edges.size());
      matrix.edges[e] *= 0.9;
      changed.insert(edges[e].begin(), edges[e].end());
    }
    for (const auto node : changed) {
      matrix.diagonal[node] += 0.01;
      b[node] += 1;
    }
    edited.eliminate_again(matrix, b, std::vector<std::int32_t>(changed.begin(), changed.end()));
    FrontalCholesky fresh(count, edges);
    fresh.eliminate(matrix, b);
    CHECK(edited.solution() == fresh.solution());
  }
}

TEST_CASE("a matrix that is not positive definite is refused, and the next one solved") {
  const Edges edges{{0, 1}};
  FrontalCholesky cholesky(2, edges);
  const Eigen::VectorXcd b = Eigen::VectorXcd::Ones(2);
  CHECK_THROWS_AS(cholesky.eliminate({{1, 1}, {Complex(0, 2)}}, b), SolverFailure);
  cholesky.eliminate({{1, 4}, {Complex(0, 1)}}, b);
  CHECK((cholesky.solution() - Eigen::Vector2cd(Complex(4, 1) / 3.0, Complex(1, -1) / 3.0)).norm() <= 1e-15);
}

}  // namespace pectinate::test
