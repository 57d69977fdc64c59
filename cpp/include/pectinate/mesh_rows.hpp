// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace pectinate {

/// A triangle's side in the surface: the triangle across it, or none.
struct SideNeighbour {
  std::int32_t triangle = -1;  ///< -1 at a border (also where a non-manifold edge was cut)
  std::int8_t side = -1;       ///< the side of that triangle
};

/// The same in four bytes, and whether the two sides run the same way round: where they do, windings disagree.
class PackedNeighbour {
 public:
  PackedNeighbour() = default;
  PackedNeighbour(std::int32_t triangle, int side, bool runs_alike)
      : PackedNeighbour(4 * triangle + side, runs_alike) {}
  PackedNeighbour(std::int32_t side_number, bool runs_alike)  ///< 4 triangle + side
      : code_(static_cast<std::uint32_t>(side_number) << 1 | static_cast<std::uint32_t>(runs_alike)) {}

  bool exists() const { return code_ != none; }
  std::int32_t triangle() const { return static_cast<std::int32_t>(code_ >> 3); }
  int side() const { return static_cast<int>(code_ >> 1 & 3); }
  bool runs_alike() const { return code_ & 1; }
  SideNeighbour unpacked() const {
    return exists() ? SideNeighbour{triangle(), static_cast<std::int8_t>(side())} : SideNeighbour{};
  }

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};  // no side has number 3

  std::uint32_t code_ = none;
};

/// The triangles at an edge, in ascending order; valid as long as the mesh.
class EdgeTriangles {
 public:
  explicit EdgeTriangles(std::int32_t only) : few_{only, 0}, size_(1) {}
  EdgeTriangles(std::int32_t first, std::int32_t second) : few_{first, second}, size_(2) {}
  explicit EdgeTriangles(std::span<const std::int32_t> many) : many_(many.data()), size_(many.size()) {}

  std::size_t size() const { return size_; }
  const std::int32_t* begin() const { return many_ == nullptr ? few_.data() : many_; }
  const std::int32_t* end() const { return begin() + size_; }
  std::int32_t operator[](std::size_t i) const { return begin()[i]; }
  std::int32_t front() const { return *begin(); }
  std::int32_t back() const { return begin()[size_ - 1]; }

 private:
  const std::int32_t* many_ = nullptr;
  std::array<std::int32_t, 2> few_{};
  std::size_t size_;
};

template <auto At>
class ComputedRow;

/// A row of values that are computed each time they are asked for; as cheap to copy as a pointer, valid as long as what
/// it was got from.
template <class Source, class Value, Value (Source::*At)(std::int32_t) const>
class ComputedRow<At> {
 public:
  class Iterator {
   public:
    using value_type = Value;                // NOLINT(readability-identifier-naming): the standard's name
    using difference_type = std::ptrdiff_t;  // NOLINT(readability-identifier-naming): the standard's name

    Iterator() = default;
    Iterator(const Source* source, std::int32_t i) : source_(source), i_(i) {}
    Value operator*() const { return (source_->*At)(i_); }
    Iterator& operator++() {
      ++i_;
      return *this;
    }
    Iterator operator++(int) {
      const auto before = *this;
      ++i_;
      return before;
    }
    Iterator operator+(difference_type n) const { return {source_, static_cast<std::int32_t>(i_ + n)}; }
    bool operator==(const Iterator&) const = default;

   private:
    const Source* source_ = nullptr;
    std::int32_t i_ = 0;
  };

  ComputedRow(const Source& source, std::size_t size) : source_(&source), size_(size) {}

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  Value operator[](std::size_t i) const { return (source_->*At)(static_cast<std::int32_t>(i)); }
  Iterator begin() const { return {source_, 0}; }
  Iterator end() const { return {source_, static_cast<std::int32_t>(size_)}; }
  friend bool operator==(const ComputedRow& row, const std::vector<Value>& values) {
    return std::ranges::equal(row, values);
  }

 private:
  const Source* source_;
  std::size_t size_;
};

}  // namespace pectinate
