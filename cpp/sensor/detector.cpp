#include "sensor/detector.hpp"

#include "base/random.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace firetwin::sensor {
namespace {

/// Weights of a Gaussian at integer distances from its centre; the two-sided sum is 1.
std::vector<double> gaussian(double sigma) {
  const auto reach = static_cast<std::size_t>(std::ceil(4.0 * sigma));
  std::vector<double> weight(reach + 1);
  double sum = 0.0;
  for (std::size_t i = 0; i <= reach; ++i) {
    const double x = static_cast<double>(i) / sigma;
    weight[i] = std::exp(-0.5 * x * x);
    sum += (i ? 2.0 : 1.0) * weight[i];
  }
  for (double& each : weight) {
    each /= sum;
  }
  return weight;
}

/// Blurs each row of an image and writes it as a column.
std::vector<float> blurred_turned(std::span<const float> image, std::size_t height,
                                  std::size_t width, std::span<const double> weight) {
  std::vector<float> turned(image.size());
  tbb::parallel_for(std::size_t{0}, height, [&](std::size_t row) {
    const auto line = image.subspan(row * width, width);
    for (std::size_t x = 0; x < width; ++x) {
      double sum = weight[0] * static_cast<double>(line[x]);
      for (std::size_t i = 1; i < weight.size(); ++i) {
        const float left = line[x < i ? 0 : x - i], right = line[std::min(x + i, width - 1)];
        sum += weight[i] * (static_cast<double>(left) + static_cast<double>(right));
      }
      turned[x * height + row] = static_cast<float>(sum);
    }
  });
  return turned;
}

/// Standard normal number of a pixel (G. E. P. Box and M. E. Muller 1958).
double normal(std::uint64_t key, std::size_t pixel) {
  const double a = 1.0 - uniform(key, 2 * pixel), b = uniform(key, 2 * pixel + 1);
  return std::sqrt(-2.0 * std::log(a)) * std::cos(2.0 * std::numbers::pi * b);
}

} // namespace

void check(const Detector& detector) {
  for (const double value : {detector.blur, detector.noise, detector.saturation}) {
    if (!(value >= 0.0) || !std::isfinite(value)) {
      throw std::invalid_argument("blur, noise and saturation must be 0 or more and finite");
    }
  }
  if (detector.bits < 0 || detector.bits > 16) {
    throw std::invalid_argument("bits must be from 0 to 16");
  }
  if (detector.bits > 0 && detector.saturation == 0.0) {
    throw std::invalid_argument("counts need a saturation, which defines full scale");
  }
}

void detect(const Detector& detector, const PlanckTable& table, std::uint64_t key,
            std::size_t height, std::size_t width, std::span<float> radiance,
            std::span<std::uint16_t> counts) {
  check(detector);
  if (detector.blur > 0.0) {
    const auto weight = gaussian(detector.blur);
    const auto turned = blurred_turned(radiance, height, width, weight);
    std::ranges::copy(blurred_turned(turned, width, height, weight), radiance.begin());
  }
  const double at = sensor::radiance(noise_reference, table.band());
  const double noise =
      detector.noise * temperature_exponent(noise_reference, table.band()) * at / noise_reference;
  const double most = sensor::radiance(detector.saturation, table.band());
  const double steps = std::ldexp(1.0, detector.bits) - 1.0;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, radiance.size(), 4096), [&](auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      auto value = static_cast<double>(radiance[i]);
      if (noise > 0.0) {
        value = std::max(value + noise * normal(key, i), 0.0);
      }
      if (detector.saturation > 0.0) {
        value = std::min(value, most);
      }
      if (detector.bits > 0) {
        const double count = std::isnan(value) ? 0.0 : std::round(value / most * steps);
        counts[i] = static_cast<std::uint16_t>(count);
        value = count * most / steps;
      }
      radiance[i] = static_cast<float>(value);
    }
  });
}

} // namespace firetwin::sensor
