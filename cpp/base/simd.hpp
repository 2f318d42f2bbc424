#pragma once

#include <cstddef>
#include <cstring>

/// Explicit SIMD vectors for sums that must stay in registers and for lane permutations, where
/// auto-vectorized loops are several times slower. All other loops are plain loops over __restrict
/// pointers in multiversioned functions (base/clones.hpp).
namespace firetwin {

template <class T, std::size_t lanes> struct SimdOf {
  using Type __attribute__((vector_size(lanes * sizeof(T)))) = T;
};

/// Vector of `lanes` numbers of type T. Pass it by reference: the ABI for passing it by value
/// depends on the target.
template <class T, std::size_t lanes> using Simd = typename SimdOf<T, lanes>::Type;

constexpr std::size_t lane_count = 8;
using Lanes = Simd<float, lane_count>;
using WideLanes = Simd<double, 4>;

template <class T, class Vector>
__attribute__((always_inline)) inline void load(const T* from, Vector& to) {
  std::memcpy(&to, from, sizeof to);
}

template <class Vector, class T>
__attribute__((always_inline)) inline void store(const Vector& from, T* to) {
  std::memcpy(to, &from, sizeof from);
}

} // namespace firetwin
