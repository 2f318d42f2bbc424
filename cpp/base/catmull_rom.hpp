#pragma once

#include <array>

namespace firetwin {

/// Weights of four consecutive values for a point at the fraction `t`, 0 to 1, between the second
/// and the third (Catmull and Rom 1974).
template <class T> constexpr std::array<T, 4> catmull_rom(T t) {
  const T half{0.5F};
  return {half * t * (T{-1} + t * (T{2} - t)), T{1} + half * t * t * (T{-5} + T{3} * t),
          half * t * (T{1} + t * (T{4} - T{3} * t)), half * t * t * (t - T{1})};
}

} // namespace firetwin
