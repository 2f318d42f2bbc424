#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>

/// Compiles a function twice, for any x86-64 and for AVX2, and picks one when the program starts.
/// Neither contracts products and sums, so both give the same numbers. Sanitisers cannot follow the
/// picking.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) &&                             \
    !defined(__SANITIZE_ADDRESS__)
#define FIRETWIN_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define FIRETWIN_CLONES
#endif

namespace firetwin {

constexpr std::size_t kLanes = 8;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using WideLanes = double __attribute__((vector_size(4 * sizeof(double))));

} // namespace firetwin
