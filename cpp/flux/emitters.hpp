#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::flux {

/// Fire emitters at one time, one per burning cell, ordered by cell.
struct Emitters {
  std::vector<std::int64_t> cell; ///< y nx + x
  std::vector<double> position;   ///< [3 n] m
  std::vector<double> intensity;  ///< F_curved, 0..1
  std::vector<double> scale;      ///< 100..150
  std::vector<double> colour;     ///< 100..500
  std::vector<float> flux;        ///< W/m2
  std::size_t invalid = 0;        ///< cells without an emitter because their flux is NaN
};

/// Algorithm 1 of the FIRETWIN paper: one emitter per cell with flux > 0, with scale = 100 + 50
/// F_curved and colour = 100 + 400 F_curved, where F_curved = clamp((F - Fmin)/(Fmax - Fmin), 0,
/// 1)^1.5 (equations 1 and 2). If Fmax == Fmin, F_curved is 1 for F >= Fmax and 0 below, the limit
/// of the formula; +infinity gives 1. Use the range of the complete run: a range per frame would
/// flicker.
/// @param position [3 n] m, one per flux
/// @throws std::invalid_argument unless flux_min <= flux_max are finite.
Emitters emitters(std::span<const float> flux, std::span<const double> position, double flux_min,
                  double flux_max);

} // namespace firetwin::flux
