// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <new>
#include <span>
#include <utility>
#include <vector>

namespace pectinate::detail {

/// What systems call large or huge, as a rule.
inline constexpr std::size_t large_page = std::size_t{1} << 21;

/// Asks the system to back what whole large pages lie in this memory by such; a hint.
void prefer_large_pages(void* memory, std::size_t size);

/// Asks the system to back memory that will all be written with pages at once; a hint. To do it page by page, as each
/// is written first, takes longer.
void back_with_pages(void* memory, std::size_t size);

/// So many equal elements; in large pages where they fill such.
template <class T>
std::vector<T> roomy_vector(std::size_t count, const T& value) {
  std::vector<T> result;
  result.reserve(count);
  prefer_large_pages(result.data(), count * sizeof(T));
  back_with_pages(result.data(), count * sizeof(T));
  result.resize(count, value);
  return result;
}

/// The room of an empty vector for so many elements, all or nearly all of which there will be.
template <class T>
std::span<std::byte> make_room(std::vector<T>& vector, std::size_t count) {
  vector.reserve(count);
  return {reinterpret_cast<std::byte*>(vector.data()), count * sizeof(T)};
}

/// Backs rooms with pages at once. Those that lie side by side, as the system likes to give them out, fill large pages
/// together that none of them would fill alone.
void back_together(std::vector<std::span<std::byte>> rooms);

/// Memory of large arrays that are walked over at random: in large pages, where the system has them, it costs fewer
/// page faults and less translation of addresses.
template <class T>
class LargePageAllocator {
 public:
  using value_type = T;  // NOLINT(readability-identifier-naming): the standard's name

  LargePageAllocator() = default;
  template <class U>
  explicit LargePageAllocator(const LargePageAllocator<U>&) {}

  T* allocate(std::size_t count) {
    const auto size = count * sizeof(T);
    void* memory = ::operator new(size, alignment(size));
    if (size >= large_page) prefer_large_pages(memory, size);
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) { ::operator delete(memory, alignment(count * sizeof(T))); }

  /// Elements without a value are left as the memory is: to write it twice costs as much as to compute them.
  template <class U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }

  bool operator==(const LargePageAllocator&) const = default;

 private:
  static constexpr std::size_t cache_line = 64;

  static std::align_val_t alignment(std::size_t size) {
    return std::align_val_t{size >= large_page ? large_page : cache_line};
  }
};

/// Elements of built-in types have no value until they are given one.
template <class T>
using LargeArray = std::vector<T, LargePageAllocator<T>>;

/// So many elements, all of which will be written to soon.
template <class T>
LargeArray<T> large_array(std::size_t count) {
  LargeArray<T> result;
  result.reserve(count);
  back_with_pages(result.data(), count * sizeof(T));
  result.resize(count);
  return result;
}

}  // namespace pectinate::detail
