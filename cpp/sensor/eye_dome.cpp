#include "sensor/eye_dome.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
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
  constexpr std::array<std::pair<int, int>, 8> around = {
      {{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}, {0, 1}, {1, -1}, {1, 0}, {1, 1}}};
  std::vector<float> log(depth.size());
  std::ranges::transform(depth, log.begin(), logarithm);
  const auto step = static_cast<std::ptrdiff_t>(radius);
  const auto rows = static_cast<std::ptrdiff_t>(height),
             columns = static_cast<std::ptrdiff_t>(width);
  tbb::parallel_for(std::ptrdiff_t{0}, rows, [&](std::ptrdiff_t y) {
    for (std::ptrdiff_t x = 0; x < columns; ++x) {
      const auto here = static_cast<std::size_t>(y * columns + x);
      double sum = 0.0;
      for (const auto& [down, across] : around) {
        const std::ptrdiff_t v = y + down * step, u = x + across * step;
        if (v >= 0 && v < rows && u >= 0 && u < columns) {
          const auto there = static_cast<std::size_t>(v * columns + u);
          sum += static_cast<double>(std::max(0.0F, log[here] - log[there]));
        }
      }
      shade[here] = static_cast<float>(std::exp(-strength * sum / 8.0));
    }
  });
}

} // namespace firetwin::sensor
