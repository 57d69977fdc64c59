// SPDX-License-Identifier: MIT
#include "detail/large_array.hpp"

#ifdef __linux__
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#endif

namespace pectinate::detail {

void prefer_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t size) {
#ifdef __linux__
  // What the system answers makes no difference but in speed.
  constexpr std::size_t large_page = std::size_t{1} << 21;
  const std::size_t before = -reinterpret_cast<std::uintptr_t>(memory) % large_page;
  if (size < before + large_page) return;
  (void)madvise(static_cast<char*>(memory) + before, (size - before) / large_page * large_page, MADV_HUGEPAGE);
#endif
}

void back_with_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t size) {
#if defined(__linux__) && defined(MADV_POPULATE_WRITE)
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + page - 1) / page * page;
  const auto end = (reinterpret_cast<std::uintptr_t>(memory) + size) / page * page;
  if (begin < end) (void)madvise(reinterpret_cast<void*>(begin), end - begin, MADV_POPULATE_WRITE);
#endif
}

}  // namespace pectinate::detail
