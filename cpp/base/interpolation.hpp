#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

/// Linear, bilinear and trilinear interpolation between the points of a lattice.
///
/// Done by hand elsewhere: weighted sums that leave out missing values (geo/axis.cpp,
/// forest/stand.cpp, forest/placement.cpp), and what holds values in SIMD vectors
/// (volume/march.cpp, volume/smooth.cpp).
namespace firetwin {

/// a + (b - a) t: a at t = 0, b at t = 1 within rounding; one product.
struct Lerp {
  template <class T> constexpr T operator()(T a, T b, T t) const { return a + (b - a) * t; }
};

/// a (1 - t) + b t: a at t = 0 and b at t = 1 exactly, so that a surface holds its own points.
struct ExactLerp {
  template <class T> constexpr T operator()(T a, T b, T t) const { return a * (T{1} - t) + b * t; }
};

template <class T> constexpr T lerp(T a, T b, T t) {
  return Lerp{}(a, b, t);
}

/// Bilinear interpolation.
/// @param corner value(j, i) of each corner, j and i 0 or 1
/// @param v, u how far the place is towards j = 1 and i = 1
template <class Linear = Lerp, class Corner, class T>
constexpr T bilinear(const Corner& corner, T v, T u) {
  const Linear along;
  return along(along(corner(0, 0), corner(0, 1), u), along(corner(1, 0), corner(1, 1), u), v);
}

/// Trilinear interpolation.
/// @param corner value(k, j, i) of each corner, k, j and i 0 or 1
/// @param w, v, u how far the place is towards k = 1, j = 1 and i = 1
template <class Linear = Lerp, class Corner, class T>
constexpr T trilinear(const Corner& corner, T w, T v, T u) {
  const auto level = [&](int k) {
    return bilinear<Linear>([&](int j, int i) { return corner(k, j, i); }, v, u);
  };
  return Linear{}(level(0), level(1), w);
}

/// Bilinear weights of corners (0, 0), (0, 1), (1, 0) and (1, 1), for several fields at one place.
template <class T> constexpr std::array<T, 4> bilinear_weights(T v, T u) {
  return {(T{1} - v) * (T{1} - u), (T{1} - v) * u, v * (T{1} - u), v * u};
}

/// The interval of an axis of evenly spaced points that a place is in.
template <class T> struct Interval {
  std::int64_t low, high; ///< points; the same on an axis of one point
  T part;                 ///< of the way from low to high
};

/// Places beyond an axis of `count` points are moved to its nearest end.
/// @param at fractional point, not NaN
template <class T> Interval<T> interval_within(T at, std::int64_t count) {
  const T held = std::clamp(at, T{0}, static_cast<T>(count - 1));
  const std::int64_t low =
      std::min(static_cast<std::int64_t>(held), std::max(count - 2, std::int64_t{0}));
  return {low, std::min(low + 1, count - 1), held - static_cast<T>(low)};
}

/// Beyond an axis of `count` points the first and last interval go on: part is below 0 or above 1.
/// @param at fractional point; NaN: part is NaN
template <class T> Interval<T> interval_extended(T at, std::int64_t count) {
  const T last = count > 2 ? static_cast<T>(count - 2) : T{0};
  const T whole = at > T{0} ? std::min(std::floor(at), last) : T{0};
  const auto low = static_cast<std::int64_t>(whole);
  return {low, std::min(low + 1, count - 1), at - whole};
}

} // namespace firetwin
