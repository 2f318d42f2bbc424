#include "sensor/eye_dome.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

namespace firetwin::sensor {
namespace {

constexpr float deepest = 1e9F, nearest = 1e-3F;

float logarithm(float depth) {
  return std::log2(std::isnan(depth) ? deepest : std::clamp(depth, nearest, deepest));
}

} // namespace

void eye_dome(std::span<const float> depth, std::size_t height, std::size_t width, double strength,
              std::size_t radius, std::span<float> shade) {
  if (!(strength >= 0.0) || !std::isfinite(strength) || radius == 0) {
    throw std::invalid_argument("strength must be 0 or more, radius above 0");
  }
  radius = std::min(radius, std::max(height, width)); // no neighbours beyond the image
  // Logarithms with a rim at infinite depth, which is never nearer than a pixel.
  const std::size_t wide = width + 2 * radius;
  std::vector<float> log((height + 2 * radius) * wide, std::numeric_limits<float>::infinity());
  tbb::parallel_for(std::size_t{0}, height, [&](std::size_t y) {
    std::ranges::transform(depth.subspan(y * width, width),
                           log.begin() + static_cast<std::ptrdiff_t>((y + radius) * wide + radius),
                           logarithm);
  });
  const auto scale = static_cast<float>(strength / 8.0);
  tbb::parallel_for(std::size_t{0}, height, [&](std::size_t y) {
    const float* const above = &log[y * wide];
    const float* const beside = above + radius * wide;
    const float* const below = beside + radius * wide;
    const std::span<float> row = shade.subspan(y * width, width);
    for (std::size_t x = 0; x < width; ++x) { // branch-free, so that it is vectorized
      const float here = beside[x + radius];
      float sum = 0.0F;
      for (const float* const line : {above, beside, below}) {
        for (const std::size_t across : {x, x + radius, x + 2 * radius}) {
          sum += std::max(0.0F, here - line[across]);
        }
      }
      row[x] = -scale * sum;
    }
    std::ranges::transform(row, row.begin(), [](float power) { return std::exp(power); });
  });
}

} // namespace firetwin::sensor
