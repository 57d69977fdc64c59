// SPDX-License-Identifier: MIT
#include "detail/frontal_cholesky.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <numeric>

#include "detail/elimination_tree.hpp"
#include "pectinate/errors.hpp"

namespace pectinate::detail {
namespace {

/// Columns join a front although their patterns differ a little, because dense work is cheap and fronts are not: as
/// long as the front is small, or has no more than this share of zeros.
constexpr double tolerated_zeros = 0.2;
constexpr std::int32_t small_front = 8;
/// Within a front's columns products are complex, beyond them split into real ones.
constexpr std::int32_t largest_front = 40;

/// Subtrees of fewer columns are done again as a whole, and keep nothing inside.
constexpr std::int32_t small_subtree = 200;

bool worth_joining(double columns, double height, double needed) {
  const double stored = columns * (columns + 1) / 2 + columns * height;
  return stored - needed <= tolerated_zeros * stored;
}

/// For each column the root of the greatest subtree of few columns that it lies in, -1 where it lies in none.
std::vector<std::int32_t> small_subtrees(const std::vector<std::int32_t>& parents) {
  const auto count = static_cast<std::int32_t>(parents.size());
  std::vector<std::int32_t> size(count, 1), root(count, -1);
  for (std::int32_t j = 0; j < count; ++j) {
    if (parents[j] >= 0) size[parents[j]] += size[j];
  }
  for (std::int32_t j = count - 1; j >= 0; --j) {
    if (size[j] <= small_front) root[j] = parents[j] >= 0 && root[parents[j]] >= 0 ? root[parents[j]] : j;
  }
  return root;
}

/// Lower triangle of target - left left^H, for real and imaginary parts kept apart.
void subtract_square(const Eigen::Ref<const Eigen::MatrixXcd>& left, Eigen::MatrixXd& real,
                     Eigen::MatrixXd& imaginary) {
  const Eigen::Index rows = left.rows(), count = left.cols();
  Eigen::MatrixXd parts(rows, 2 * count), turned(rows, 2 * count);
  parts << left.real(), left.imag();
  turned << left.imag(), -left.real();
  real.selfadjointView<Eigen::Lower>().rankUpdate(parts, -1);
  imaginary.triangularView<Eigen::Lower>() -= turned * parts.transpose();
}

/// The sum of conj(a) b. Most fronts are too small for a library's kernels.
std::complex<double> conjugate_dot(const std::complex<double>* a, const std::complex<double>* b, Eigen::Index count) {
  const auto product = [&](Eigen::Index i) {
    return std::array{a[i].real() * b[i].real() + a[i].imag() * b[i].imag(),
                      a[i].real() * b[i].imag() - a[i].imag() * b[i].real()};
  };
  std::array<double, 2> even{}, odd{};  // sums that need not wait for each other
  Eigen::Index i = 0;
  for (; i + 1 < count; i += 2) {
    const auto first = product(i), second = product(i + 1);
    even = {even[0] + first[0], even[1] + first[1]};
    odd = {odd[0] + second[0], odd[1] + second[1]};
  }
  if (i < count) {
    const auto last = product(i);
    even = {even[0] + last[0], even[1] + last[1]};
  }
  return {even[0] + odd[0], even[1] + odd[1]};
}

}  // namespace

FrontalCholesky::FrontalCholesky(std::int32_t node_count, std::span<const Edge> edges)
    : place_(node_count), local_(node_count) {
  EliminationTree tree = make_elimination_tree(node_count, edges);
  node_ = std::move(tree.order);
  for (std::int32_t i = 0; i < node_count; ++i) place_[node_[i]] = i;
  collect_entries(edges);
  make_fronts(tree.parent);
  link_fronts();
}

void FrontalCholesky::collect_entries(std::span<const Edge> edges) {
  offsets_.assign(place_.size() + 1, 0);
  for (const auto& [a, b] : edges) ++offsets_[std::min(place_[a], place_[b]) + 1];
  std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
  entries_.resize(edges.size());
  std::vector<std::int32_t> next(offsets_.begin(), offsets_.end() - 1);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [column, row] = std::minmax(place_[edges[e][0]], place_[edges[e][1]]);
    entries_[next[column]++] = {row, static_cast<std::int32_t>(e), row == place_[edges[e][0]]};
  }
}

std::vector<std::int32_t> FrontalCholesky::rows_below(std::int32_t column, const Columns& below,
                                                      std::span<const std::int32_t> children) {
  std::vector<std::int32_t> rows;
  const auto add = [&](std::int32_t row) {
    if (row == column || local_[row] == column) return;
    local_[row] = column;
    rows.push_back(row);
  };
  for (auto e = offsets_[column]; e < offsets_[column + 1]; ++e) add(entries_[e].row);
  for (const auto child : children) std::ranges::for_each(below[child], add);
  std::ranges::sort(rows);
  return rows;
}

void FrontalCholesky::make_fronts(const std::vector<std::int32_t>& parents) {
  const auto count = static_cast<std::int32_t>(parents.size());
  Columns below(count), children(count);
  const auto subtree = small_subtrees(parents);
  front_of_.resize(count);
  std::ranges::fill(local_, -1);
  double needed = 0;  // entries of the last front's columns, without the zeros that it stores
  for (std::int32_t j = 0; j < count; ++j) {
    below[j] = rows_below(j, below, children[j]);
    for (const auto child : children[j]) below[child] = {};
    if (parents[j] >= 0) children[parents[j]].push_back(j);
    const auto height = static_cast<double>(below[j].size());
    const bool same_subtree = j > 0 && subtree[j] >= 0 && subtree[j] == subtree[j - 1];
    const bool chained = j > 0 && parents[j - 1] == j && fronts_.back().count < largest_front;
    if (!same_subtree && !(chained && worth_joining(fronts_.back().count + 1, height, needed + height + 1))) {
      fronts_.emplace_back().first = j;
      needed = 0;
    }
    needed += height + 1;
    Front& front = fronts_.back();
    ++front.count;
    front.parent = parents[j];
    front.rows = below[j];
    front_of_[j] = static_cast<std::int32_t>(fronts_.size()) - 1;
  }
}

void FrontalCholesky::link_fronts() {
  std::vector<std::int32_t> subtree(fronts_.size(), 0);
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    Front& front = fronts_[f];
    subtree[f] += front.count;
    if (front.parent < 0) continue;
    front.parent = front_of_[front.parent];
    Front& parent = fronts_[front.parent];
    parent.children.push_back(static_cast<std::int32_t>(f));
    subtree[front.parent] += subtree[f];
    front.in_parent.reserve(front.rows.size());
    auto place = parent.rows.begin();
    for (const auto row : front.rows) {
      if (row < parent.first + parent.count) {
        front.in_parent.push_back(row - parent.first);
        continue;
      }
      place = std::lower_bound(place, parent.rows.end(), row);
      front.in_parent.push_back(parent.count + static_cast<std::int32_t>(place - parent.rows.begin()));
    }
  }
  Eigen::Index entries = 0;
  for (auto& front : fronts_) {
    front.columns_at = static_cast<std::size_t>(entries);
    entries += front.count * (front.count + static_cast<Eigen::Index>(front.rows.size()));
  }
  const auto places = static_cast<Eigen::Index>(place_.size());
  factor_.resize(entries);
  reduced_.resize(places);
  solved_.resize(places);
  solution_.resize(places);
  for (auto& front : fronts_) front.keeps_contribution = front.parent >= 0 && subtree[front.parent] >= small_subtree;
}

void FrontalCholesky::eliminate(const HermitianMatrix& matrix, const Eigen::VectorXcd& right_hand_side) {
  for (Front& front : fronts_) {
    factorize(front, matrix);
    substitute(front, right_hand_side);
  }
}

void FrontalCholesky::eliminate_again(const HermitianMatrix& matrix, const Eigen::VectorXcd& right_hand_side,
                                      std::span<const std::int32_t> changed_nodes) {
  const auto selected = fronts_above(changed_nodes);
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    if (!selected[f]) continue;
    factorize(fronts_[f], matrix);
    substitute(fronts_[f], right_hand_side);
  }
}

void FrontalCholesky::replace(const Eigen::VectorXcd& right_hand_side) {
  for (Front& front : fronts_) substitute(front, right_hand_side);
}

std::vector<bool> FrontalCholesky::fronts_above(std::span<const std::int32_t> nodes) const {
  std::vector<bool> selected(fronts_.size(), false);
  for (const auto node : nodes) selected[front_of_[place_[node]]] = true;
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    if (selected[f] && fronts_[f].parent >= 0) selected[fronts_[f].parent] = true;
  }
  for (std::size_t f = fronts_.size(); f-- > 0;) {
    const auto parent = fronts_[f].parent;
    if (parent >= 0 && selected[parent] && !fronts_[f].keeps_contribution) selected[f] = true;
  }
  return selected;
}

void FrontalCholesky::factorize(Front& front, const HermitianMatrix& matrix) {
  assemble(front, matrix);
  auto top = columns(front).topRows(front.count);
  auto left = columns(front).bottomRows(static_cast<Eigen::Index>(front.rows.size()));
  if (Eigen::LLT<Eigen::Ref<Block>> cholesky(top); cholesky.info() != Eigen::Success) {
    throw SolverFailure("the matrix is not positive definite");
  }
  if (!front.rows.empty()) {
    top.adjoint().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(left);
    subtract_square(left, front.contribution.real, front.contribution.imaginary);
  }
  for (const auto child : front.children) {
    if (!fronts_[child].keeps_contribution) fronts_[child].contribution = {};
  }
}

void FrontalCholesky::substitute(Front& front, const Eigen::VectorXcd& right_hand_side) {
  const auto below = static_cast<Eigen::Index>(front.rows.size());
  auto reduced = reduced_.segment(front.first, front.count);
  front.passed_on.setZero(below);
  for (std::int32_t k = 0; k < front.count; ++k) reduced[k] = right_hand_side[node_[front.first + k]];
  for (const auto c : front.children) {
    const Front& child = fronts_[c];
    for (std::size_t k = 0; k < child.in_parent.size(); ++k) {
      const auto place = child.in_parent[k];
      (place < front.count ? reduced[place] : front.passed_on[place - front.count]) += child.passed_on[k];
    }
  }
  columns(front).topRows(front.count).triangularView<Eigen::Lower>().solveInPlace(reduced);
  front.passed_on.noalias() -= columns(front).bottomRows(below) * reduced;
}

void FrontalCholesky::assemble(Front& front, const HermitianMatrix& matrix) {
  const auto count = front.count;
  const auto below = static_cast<Eigen::Index>(front.rows.size());
  auto dense = columns(front);
  dense.setZero();
  front.contribution.real.setZero(below, below);
  front.contribution.imaginary.setZero(below, below);
  for (std::size_t k = 0; k < front.rows.size(); ++k) local_[front.rows[k]] = count + static_cast<std::int32_t>(k);
  for (std::int32_t k = 0; k < count; ++k) {
    const std::int32_t column = front.first + k;
    dense(k, k) = matrix.diagonal[node_[column]];
    for (auto e = offsets_[column]; e < offsets_[column + 1]; ++e) {
      const auto& [row, edge, conjugated] = entries_[e];
      const auto place = row < front.first + count ? row - front.first : local_[row];
      dense(place, k) = conjugated ? std::conj(matrix.edges[edge]) : matrix.edges[edge];
    }
  }
  for (const auto child : front.children) contribute(front, fronts_[child]);
}

void FrontalCholesky::contribute(Front& front, const Front& child) {
  auto dense = columns(front);
  auto& [real, imaginary] = front.contribution;
  const auto size = static_cast<Eigen::Index>(child.rows.size());
  Eigen::Index j = 0;
  for (; j < size && child.in_parent[j] < front.count; ++j) {
    auto* column = &dense(0, child.in_parent[j]);
    for (Eigen::Index i = j; i < size; ++i) {
      column[child.in_parent[i]] +=
          std::complex<double>(child.contribution.real(i, j), child.contribution.imaginary(i, j));
    }
  }
  for (; j < size; ++j) {
    const auto to = child.in_parent[j] - front.count;
    for (Eigen::Index i = j; i < size; ++i) {
      real(child.in_parent[i] - front.count, to) += child.contribution.real(i, j);
      imaginary(child.in_parent[i] - front.count, to) += child.contribution.imaginary(i, j);
    }
  }
}

const Eigen::VectorXcd& FrontalCholesky::solution() {
  std::vector<std::complex<double>> tail;
  for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
    const Eigen::Index count = front->count, height = count + static_cast<Eigen::Index>(front->rows.size());
    tail.resize(height);
    for (Eigen::Index k = count; k < height; ++k) tail[k] = solved_[front->rows[k - count]];
    for (Eigen::Index k = count - 1; k >= 0; --k) {
      const auto* column = factor_.data() + front->columns_at + k * height;
      const auto known = conjugate_dot(column + k + 1, tail.data() + k + 1, height - k - 1);
      tail[k] = (reduced_[front->first + k] - known) / column[k].real();
    }
    std::copy_n(tail.begin(), count, &solved_[front->first]);
  }
  for (Eigen::Index i = 0; i < solved_.size(); ++i) solution_[node_[i]] = solved_[i];
  return solution_;
}

}  // namespace pectinate::detail
