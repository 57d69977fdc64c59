// SPDX-License-Identifier: MIT
#include "detail/large_array.hpp"

#ifdef __linux__
#include <sys/mman.h>

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

}  // namespace pectinate::detail
