// SPDX-License-Identifier: MIT
// Compiles the file PECTINATE_KERNEL three times: in the namespace any_processor for registers of 16 bytes, which all
// have, in with_avx2 for those of 32, and in with_avx512 for twice as many of these and others for masks; registers of
// 64 bytes gain nothing more. PECTINATE_CALL_KERNEL(f, arguments) calls the one that suits the processor at hand. All
// give the same bits: they do the same to each number, as long as the compiler fuses no multiplication with an
// addition.

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define PECTINATE_HAS_VARIANTS
#endif

namespace {

#ifdef PECTINATE_HAS_VARIANTS
#define PECTINATE_SIGN_BITS __builtin_ia32_movmskps
#endif
namespace any_processor {
constexpr int floats = 4, doubles = 2;
#include PECTINATE_KERNEL
}  // namespace any_processor

#ifdef PECTINATE_HAS_VARIANTS
#undef PECTINATE_SIGN_BITS
#define PECTINATE_SIGN_BITS __builtin_ia32_movmskps256
#pragma GCC push_options
#pragma GCC target("avx2")
namespace with_avx2 {
constexpr int floats = 8, doubles = 4;
#include PECTINATE_KERNEL
}  // namespace with_avx2
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("arch=x86-64-v4")
namespace with_avx512 {
constexpr int floats = 8, doubles = 4;
#include PECTINATE_KERNEL
}  // namespace with_avx512
#pragma GCC pop_options
#undef PECTINATE_SIGN_BITS

const bool has_avx2 = __builtin_cpu_supports("avx2"), has_avx512 = __builtin_cpu_supports("x86-64-v4");
#endif

}  // namespace

#undef PECTINATE_KERNEL
#ifdef PECTINATE_HAS_VARIANTS
#define PECTINATE_CALL_KERNEL(function, ...)       \
  (has_avx512 ? with_avx512::function(__VA_ARGS__) \
   : has_avx2 ? with_avx2::function(__VA_ARGS__)   \
              : any_processor::function(__VA_ARGS__))
#else
#define PECTINATE_CALL_KERNEL(function, ...) any_processor::function(__VA_ARGS__)
#endif
