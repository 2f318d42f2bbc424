#pragma once

#include <algorithm>

namespace firetwin {

/// 0 up to `low`, 1 from `high` on, 3 t^2 - 2 t^3 in between.
template <class T> T smoothstep(T low, T high, T x) {
  const T t = std::clamp((x - low) / (high - low), T{0}, T{1});
  return t * t * (T{3} - T{2} * t);
}

} // namespace firetwin
