#include "flow/thermodynamics.hpp"

#include "base/clones.hpp"

#include <bit>
#include <cstdint>

namespace firetwin::flow {
namespace {

constexpr float freezing = 273.15F;
constexpr float steepness = 17.625F;
constexpr float offset = 243.04F; // degrees Celsius
constexpr float molar_ratio = 0.622F;
constexpr auto warming = static_cast<float>(latent_heat / constants::specific_heat);
constexpr int rounds = 4; // iterations of Newton's method

/// Computes exp(x) for |x| < 80 within 2e-7 by powers of 2 and a Taylor polynomial, which
/// vectorise.
inline float exponential(float x) {
  constexpr float whole = 12582912.0F; // 1.5 x 2^23: adding it rounds to integers
  const float y = x * 1.44269504F;
  const float n = (y + whole) - whole;
  const float f = (y - n) * 0.69314718F;
  const float series =
      1.0F +
      f * (1.0F + f * (0.5F + f * (1.0F / 6.0F + f * (1.0F / 24.0F +
                                                      f * (1.0F / 120.0F + f * (1.0F / 720.0F))))));
  const auto power = static_cast<std::int32_t>(n);
  return series * std::bit_cast<float>((power + 127) << 23);
}

/// Saturation mixing ratio, kg/kg, and its derivative with temperature, 1/K.
struct Saturation {
  float water;
  float slope;
};

inline Saturation saturation(float kelvin, float pressure) {
  const float c = kelvin - freezing, low = c < -150.0F ? -150.0F : c;
  const float celsius = low > 90.0F ? 90.0F : low;
  const float inverse = 1.0F / (celsius + offset);
  const float vapour = 610.94F * exponential(steepness * celsius * inverse);
  const float dry = pressure - (1.0F - molar_ratio) * vapour;
  const float water = molar_ratio * vapour / (dry > vapour ? dry : vapour);
  return {water, water * (steepness * offset) * inverse * inverse};
}

FIRETWIN_CLONES("avx512f", "avx2")
float most_above_saturation(Index n, const float* __restrict theta, const float* __restrict water,
                            const LevelReference& level, float* __restrict virtual_theta) {
  const float reference = level.reference, exner = level.exner, pressure = level.pressure;
  for (Index i = 0; i < n; ++i) {
    virtual_theta[i] = water[i] - saturation((theta[i] + reference) * exner, pressure).water;
  }
  float most = 0.0F;
  for (Index i = 0; i < n; ++i) {
    most = virtual_theta[i] > most ? virtual_theta[i] : most;
  }
  return most;
}

/// Solves by Newton's method, with the same number of iterations for all cells. In unsaturated air
/// `cloud` becomes negative, and is clamped to 0.
FIRETWIN_CLONES("avx512f", "avx2")
void condense(Index n, const float* __restrict theta, const float* __restrict water,
              const LevelReference& level, float* __restrict cloud) {
  const float reference = level.reference, exner = level.exner, pressure = level.pressure;
  for (Index i = 0; i < n; ++i) {
    const float temperature = (theta[i] + reference) * exner, all = water[i];
    float condensed = 0.0F;
    for (int round = 0; round < rounds; ++round) {
      const Saturation vapour = saturation(temperature + warming * condensed, pressure);
      condensed += (all - condensed - vapour.water) / (1.0F + warming * vapour.slope);
    }
    const float some = condensed > 0.0F ? condensed : 0.0F;
    cloud[i] = some < all ? some : all;
  }
}

FIRETWIN_CLONES("avx512f", "avx2")
void lighten(Index n, const float* __restrict theta, const float* __restrict water,
             const float* __restrict cloud, const LevelReference& level,
             float* __restrict virtual_theta) {
  constexpr auto lightness = static_cast<float>(vapour_lightness);
  const float reference = level.reference, latent = warming / level.exner;
  for (Index i = 0; i < n; ++i) {
    const float warm = (theta[i] + reference) + latent * cloud[i];
    virtual_theta[i] = warm * (1.0F + lightness * (water[i] - cloud[i]) - cloud[i]);
  }
}

} // namespace

void virtual_row(Index n, const float* theta, const float* water, const LevelReference& level,
                 float* virtual_theta, float* cloud) {
  if (most_above_saturation(n, theta, water, level, virtual_theta) > 0.0F) {
    condense(n, theta, water, level, cloud);
  } else {
    for (Index i = 0; i < n; ++i) {
      cloud[i] = 0.0F;
    }
  }
  lighten(n, theta, water, cloud, level, virtual_theta);
}

} // namespace firetwin::flow
