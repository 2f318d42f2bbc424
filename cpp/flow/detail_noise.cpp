#include "flow/detail_noise.hpp"

#include "base/clones.hpp"
#include "base/interpolation.hpp"
#include "base/sparse_smoke.hpp"

#include <algorithm>
#include <cmath>

namespace firetwin::flow {
namespace {

constexpr float roughness = NoiseFrame::roughness;
constexpr double finer = NoiseFrame::finer;
// Voxels, wavelength of the finest octave. Ridges repeat after half a wavelength: finer ones would
// draw the lattice of the voxels.
constexpr double finest_wave = 1.7, finest_ridges = 3.4;
constexpr double outline_width = 2.0;  // voxels
constexpr double billow_height = 1.25; // factor on the distance to the nearest point
constexpr float veils_only = 0.02F, billows_only = 0.98F; // vigour

FIRETWIN_CLONES("avx512f", "avx2")
void scale(const std::array<double, static_cast<std::size_t>(lanes)>& places, double by, Row& out) {
  for (std::size_t n = 0; n < out.size(); ++n) {
    out[n] = static_cast<float>(places[n] * by);
  }
}

FIRETWIN_CLONES("avx512f", "avx2")
void add_veils(float share, const Row& vigour, float most, const Row& perlin, Row& soft) {
  for (std::size_t n = 0; n < soft.size(); ++n) {
    soft[n] += vigour[n] < most ? share * 0.9F * perlin[n] : 0.0F;
  }
}

FIRETWIN_CLONES("avx512f", "avx2")
void add_billows(float share, const Row& distance, Row& crisp) {
  for (std::size_t n = 0; n < crisp.size(); ++n) {
    crisp[n] += share * (static_cast<float>(billow_height) * (0.49F - distance[n]));
  }
}

FIRETWIN_CLONES("avx512f", "avx2")
void add_ridges(float share, const Row& perlin, Row& crisp) {
  for (std::size_t n = 0; n < crisp.size(); ++n) {
    crisp[n] += share * (0.6F * (0.5F - 2.0F * std::abs(perlin[n])));
  }
}

FIRETWIN_CLONES("avx512f", "avx2")
void blend(const Row& soft, const Row& crisp, const Row& vigour, Row& noise) {
  for (std::size_t n = 0; n < noise.size(); ++n) {
    noise[n] = lerp(soft[n], vigour[n] > veils_only ? crisp[n] : 0.0F, vigour[n]);
  }
}

} // namespace

DetailNoise::DetailNoise(double size, double voxel,
                         const std::array<std::uint32_t, Drift::phases>& seeds)
    : size_(size), voxel_(voxel), seeds_(seeds) {}

bool DetailNoise::paints(int octave, double size) const {
  const double finest = octave < billow_octaves ? finest_wave : finest_ridges;
  return octave < max_octaves && size > finest * voxel_;
}

void DetailNoise::at(const Origins& places, std::size_t phase, const Row& vigour, Row& noise) {
  const auto [least, most] = std::minmax_element(vigour.begin(), vigour.end());
  const bool veils = *least<billows_only, billows = *most> veils_only;
  Row crisp{}, soft{}, found, x, y, z;
  float share = 1.0F;
  double size = size_;
  for (int octave = 0; paints(octave, size); ++octave) {
    const std::uint32_t own = seeds_[phase] * 8U + static_cast<std::uint32_t>(octave);
    scale(places[0], 1.0 / size, x);
    scale(places[1], 1.0 / size, y);
    scale(places[2], 1.0 / size, z);
    const bool round = octave < billow_octaves;
    if (veils || !round) {
      perlin(x, y, z, own, found);
      add_veils(share, vigour, round ? billows_only : 2.0F, found, soft);
    }
    if (billows && !round) {
      add_ridges(share, found, crisp);
    } else if (billows) {
      worley_[phase][static_cast<std::size_t>(octave)].at(x, y, z, own, found);
      add_billows(share, found, crisp);
    }
    share *= roughness;
    size *= finer;
  }
  blend(soft, crisp, vigour, noise);
}

float DetailNoise::outline() const {
  double square = 0.0, share = 1.0, size = size_;
  for (int octave = 0; paints(octave, size); ++octave) {
    square += std::pow(billow_height * share / size, 2);
    share *= static_cast<double>(roughness);
    size *= finer;
  }
  return static_cast<float>(outline_width * voxel_ * std::sqrt(square));
}

std::array<double, 2> DetailNoise::finer_octave() const {
  double share = 1.0, size = size_;
  for (int octave = 0; paints(octave, size); ++octave) {
    share *= static_cast<double>(roughness);
    size *= finer;
  }
  return {size, share};
}

} // namespace firetwin::flow
