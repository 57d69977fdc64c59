// SPDX-License-Identifier: MIT
#include "detail/large_array.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <iterator>

#ifdef __linux__
#include <sys/mman.h>
#include <unistd.h>

#include <array>
#endif

namespace pectinate::detail {
namespace {

#ifdef __linux__
/// The system's numbers of MADV_POPULATE_WRITE and MADV_COLLAPSE, which older headers lack.
constexpr int populate = 23, collapse = 25;

std::size_t small_page() {
  return static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

/// Gives the system advice about what whole pages of such a size lie in this memory. What it answers makes no
/// difference but in speed.
void advise(void* memory, std::size_t size, std::size_t page, int advice) {
  const std::size_t before = -reinterpret_cast<std::uintptr_t>(memory) % page;
  if (size < before + page) return;
  (void)madvise(static_cast<char*>(memory) + before, (size - before) / page * page, advice);
}

/// Is next to nothing of a large page there yet?
bool is_untouched(void* page) {
  std::array<unsigned char, 512> is_there{};
  const auto small_pages = static_cast<std::ptrdiff_t>(large_page / small_page());
  if (small_pages > std::ssize(is_there) || mincore(page, large_page, is_there.data()) != 0) return false;
  return 8 * std::ranges::count_if(is_there, [](auto flags) { return flags & 1; }) < small_pages;
}

#endif

/// Backs with large pages what was only touched where the allocator keeps its books, for which the system has begun
/// with small ones.
void make_large_pages([[maybe_unused]] std::byte* memory, [[maybe_unused]] std::size_t size) {
#ifdef __linux__
  for (auto i = -reinterpret_cast<std::uintptr_t>(memory) % large_page; i + large_page <= size; i += large_page) {
    if (is_untouched(memory + i)) (void)madvise(memory + i, large_page, collapse);
  }
#endif
}

}  // namespace

void prefer_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t size) {
#ifdef __linux__
  advise(memory, size, large_page, MADV_HUGEPAGE);
#endif
}

void back_with_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t size) {
#ifdef __linux__
  advise(memory, size, small_page(), populate);
#endif
}

void back_together(std::vector<std::span<std::byte>> rooms) {
  constexpr std::uintptr_t greatest_gap = 8192;  // of what the system and the allocator put between two
  const auto begin_of = [&](std::size_t i) { return reinterpret_cast<std::uintptr_t>(rooms[i].data()); };
  const auto end_of = [&](std::size_t i) { return begin_of(i) + rooms[i].size(); };
  std::erase_if(rooms, [](const auto& room) { return room.empty(); });
  std::ranges::sort(rooms, std::less{}, [](const auto& room) { return room.data(); });
  for (std::size_t first = 0, last = 0; first < rooms.size(); first = last) {
    for (++last; last < rooms.size() && begin_of(last) - end_of(last - 1) <= greatest_gap;) ++last;
    const auto size = static_cast<std::size_t>(end_of(last - 1) - begin_of(first));
    prefer_large_pages(rooms[first].data(), size);
    make_large_pages(rooms[first].data(), size);
  }
  for (const auto& room : rooms) back_with_pages(room.data(), room.size());
}

}  // namespace pectinate::detail
