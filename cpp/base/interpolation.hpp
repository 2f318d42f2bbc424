#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

/// Linear, bilinear and trilinear interpolation on a lattice.
///
/// Not used for weighted sums that skip missing values (geo/axis.cpp, forest/stand.cpp,
/// forest/placement.cpp) and for SIMD code (volume/march.cpp, volume/smooth.cpp).
namespace firetwin {

/// a + (b - a) t: exact at t = 0, within rounding at t = 1; one multiplication.
struct Lerp {
  template <class T> constexpr T operator()(T a, T b, T t) const { return a + (b - a) * t; }
};

/// a (1 - t) + b t: exact at t = 0 and t = 1, so that a surface contains its nodes.
struct ExactLerp {
  template <class T> constexpr T operator()(T a, T b, T t) const { return a * (T{1} - t) + b * t; }
};

template <class T> constexpr T lerp(T a, T b, T t) {
  return Lerp{}(a, b, t);
}

/// Bilinear interpolation.
/// @param corner value(j, i) of each corner, j and i 0 or 1
/// @param v, u fractions towards j = 1 and i = 1
template <class Linear = Lerp, class Corner, class T>
constexpr T bilinear(const Corner& corner, T v, T u) {
  const Linear along;
  return along(along(corner(0, 0), corner(0, 1), u), along(corner(1, 0), corner(1, 1), u), v);
}

/// Trilinear interpolation.
/// @param corner value(k, j, i) of each corner, k, j and i 0 or 1
/// @param w, v, u fractions towards k = 1, j = 1 and i = 1
template <class Linear = Lerp, class Corner, class T>
constexpr T trilinear(const Corner& corner, T w, T v, T u) {
  const auto level = [&](int k) {
    return bilinear<Linear>([&](int j, int i) { return corner(k, j, i); }, v, u);
  };
  return Linear{}(level(0), level(1), w);
}

/// Bilinear weights of corners (0, 0), (0, 1), (1, 0) and (1, 1), for interpolating several fields.
template <class T> constexpr std::array<T, 4> bilinear_weights(T v, T u) {
  return {(T{1} - v) * (T{1} - u), (T{1} - v) * u, v * (T{1} - u), v * u};
}

/// Interval of a regular axis that contains a point.
template <class T> struct Interval {
  std::int64_t low, high; ///< indices of its ends; equal on an axis with one point
  T part;                 ///< fraction from low to high
};

/// Finds the interval of a point, clamped to an axis of `count` points.
/// @param at fractional point, not NaN
template <class T> Interval<T> interval_within(T at, std::int64_t count) {
  const T held = std::clamp(at, T{0}, static_cast<T>(count - 1));
  const std::int64_t low =
      std::min(static_cast<std::int64_t>(held), std::max(count - 2, std::int64_t{0}));
  return {low, std::min(low + 1, count - 1), held - static_cast<T>(low)};
}

/// Finds the interval of a point; the end intervals extend beyond the axis, with part below 0 or
/// above 1.
/// @param at fractional point; NaN: part is NaN
template <class T> Interval<T> interval_extended(T at, std::int64_t count) {
  const T last = count > 2 ? static_cast<T>(count - 2) : T{0};
  const T whole = at > T{0} ? std::min(std::floor(at), last) : T{0};
  const auto low = static_cast<std::int64_t>(whole);
  return {low, std::min(low + 1, count - 1), at - whole};
}

} // namespace firetwin
