// SPDX-License-Identifier: MIT
#include "detail/large_array.hpp"

#ifdef __linux__
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#endif

namespace pectinate::detail {
namespace {

#ifdef __linux__
/// Gives the system advice about what whole pages of such a size lie in this memory. What it answers makes no
/// difference but in speed.
void advise(void* memory, std::size_t size, std::size_t page, int advice) {
  const std::size_t before = -reinterpret_cast<std::uintptr_t>(memory) % page;
  if (size < before + page) return;
  (void)madvise(static_cast<char*>(memory) + before, (size - before) / page * page, advice);
}
#endif

}  // namespace

void prefer_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t size) {
#ifdef __linux__
  advise(memory, size, std::size_t{1} << 21, MADV_HUGEPAGE);
#endif
}

void back_with_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t size) {
#if defined(__linux__) && defined(MADV_POPULATE_WRITE)
  advise(memory, size, static_cast<std::size_t>(sysconf(_SC_PAGESIZE)), MADV_POPULATE_WRITE);
#endif
}

}  // namespace pectinate::detail
