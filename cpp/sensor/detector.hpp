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
  int bits = 0;            ///< bits of the counts, proportional to radiance; 0: not quantised
};

/// Reference temperature of the NETD, K, as in data sheets.
inline constexpr double noise_reference = 300.0;

/// @throws std::invalid_argument for negative or infinite values, more than 16 bits, or bits
/// without saturation
void check(const Detector& detector);

/// Applies the detector model to radiance [height width] in place: blur (edge pixels are
/// replicated), Gaussian noise that depends only on `key` and the pixel, saturation and
/// quantisation. The result does not depend on the number of threads.
/// @param counts [height width] receives the counts; empty without quantisation
void detect(const Detector& detector, const PlanckTable& table, std::uint64_t key,
            std::size_t height, std::size_t width, std::span<float> radiance,
            std::span<std::uint16_t> counts);

} // namespace firetwin::sensor
