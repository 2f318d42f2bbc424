#pragma once

#include <cstddef>
#include <cstring>

/// Explicit SIMD vectors, for sums that must stay in registers and for lanes that are turned over:
/// what a compiler makes of loops over arrays is several times slower there. All other loops are
/// written plainly, over __restrict pointers, in functions compiled for each processor
/// (base/clones.hpp).
namespace firetwin {

template <class T, std::size_t lanes> struct SimdOf {
  using Type __attribute__((vector_size(lanes * sizeof(T)))) = T;
};

/// `lanes` numbers of type T with the arithmetic of one. Handed on by reference: how vectors are
/// passed by value differs between processors.
template <class T, std::size_t lanes> using Simd = typename SimdOf<T, lanes>::Type;

template <class T, class Vector>
__attribute__((always_inline)) inline void load(const T* from, Vector& to) {
  std::memcpy(&to, from, sizeof to);
}

template <class Vector, class T>
__attribute__((always_inline)) inline void store(const Vector& from, T* to) {
  std::memcpy(to, &from, sizeof from);
}

} // namespace firetwin
