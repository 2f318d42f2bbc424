#pragma once

#include "sensor/planck_table.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace firetwin::sensor {

/// Detector model of an infrared camera.
struct Detector {
  double blur = 0.0;       ///< standard deviation of its Gaussian point spread function, pixels
  double noise = 0.0;      ///< noise-equivalent temperature difference of black bodies at 300 K, K
  double saturation = 0.0; ///< brightness temperature at full scale, K; 0: none
  int bits = 0; ///< of its counts, which are proportional to radiance; 0: it is not quantised
};

/// The temperature at which NETD is stated (as makers of cameras do).
inline constexpr double noise_reference = 300.0;

/// @throws std::invalid_argument for negative or infinite values, more than 16 bits, or bits
/// without saturation.
void check(const Detector& detector);

/// Radiance [height width] as a detector measures it, in place: blurred (at the edges pixels go on
/// as they are), with Gaussian noise that depends on `key` and the pixel alone, cut at saturation
/// and quantised. Pixels are worked on by all threads; the result is the same for any number.
/// @param counts [height width] result, whole numbers; empty where it has no bits.
void detect(const Detector& detector, const PlanckTable& table, std::uint64_t key,
            std::size_t height, std::size_t width, std::span<float> radiance,
            std::span<std::uint16_t> counts);

} // namespace firetwin::sensor
