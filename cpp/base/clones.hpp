#pragma once

/// Compiles a function for each of the processors named and for any x86-64, and picks one when the
/// program starts. None of them contracts products and sums, so all give the same numbers.
/// Sanitisers cannot follow the picking.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) &&       \
    !defined(__SANITIZE_ADDRESS__)
#define FIRETWIN_CLONES(...) __attribute__((target_clones(__VA_ARGS__, "default")))
#else
#define FIRETWIN_CLONES(...)
#endif
