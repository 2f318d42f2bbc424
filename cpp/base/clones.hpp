#pragma once

/// Function multiversioning: compiles a function for each named target and for baseline x86-64; the
/// loader selects one. No version contracts products and sums to fused operations, so results are
/// identical. Disabled under sanitizers, which do not support it.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) &&       \
    !defined(__SANITIZE_ADDRESS__)
#define FIRETWIN_CLONES(...) __attribute__((target_clones(__VA_ARGS__, "default")))
#else
#define FIRETWIN_CLONES(...)
#endif
