#pragma once

#include <array>

namespace firetwin {

/// Weights of the values before, at, after and beyond a place that lies `t` of the way, 0 to 1,
/// from the second to the third: the cubic through both that is level with its neighbours' chords
/// (Catmull and Rom 1974).
template <class T> constexpr std::array<T, 4> catmull_rom(T t) {
  const T half{0.5F};
  return {half * t * (T{-1} + t * (T{2} - t)), T{1} + half * t * t * (T{-5} + T{3} * t),
          half * t * (T{1} + t * (T{4} - T{3} * t)), half * t * t * (t - T{1})};
}

} // namespace firetwin
