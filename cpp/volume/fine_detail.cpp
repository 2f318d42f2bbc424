#include "volume/fine_detail.hpp"

#include "base/clones.hpp"
#include "base/interpolation.hpp"
#include "base/perlin.hpp"

#include <algorithm>
#include <cmath>

namespace firetwin::volume {
namespace {

constexpr float finer = 0.47F, roughness = 0.7F; // as in flow::DetailNoise
constexpr float mean_ridge = 0.25F;              // of |Perlin noise|
constexpr float ridge_height = 1.2F;
constexpr float whole =
    1.6F; // wavelength over the finest at which an octave has its full amplitude
constexpr int max_octaves = 5;
constexpr std::uint32_t first_seed = 7; // octave number that is not painted
constexpr float body = 0.8F;            // amplitude of noise inside of the outline
constexpr float clear = 1.0e-3F;

using Lines = std::array<SampleRow, 3>;

FIRETWIN_CLONES("avx512f", "avx2")
void add_ridges(const Lines& places, float scale, std::uint32_t seed, float share,
                SampleRow& noise) {
  for (std::size_t n = 0; n < noise.size(); ++n) {
    const float found =
        perlin_at(places[0][n] * scale, places[1][n] * scale, places[2][n] * scale, seed);
    noise[n] += share * (mean_ridge - std::abs(found));
  }
}

using Corner = std::array<float, NoiseFrame::parts>;

Corner between(const NoiseFrame& frame, const std::array<std::int64_t, 3>& block,
               const std::array<float, 3>& part) {
  Corner sum{};
  for (std::size_t n = 0; n < 8; ++n) {
    const std::array<std::size_t, 3> high{n & 1U, n >> 1U & 1U, n >> 2U};
    float weight = 1.0F;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      weight *= high[axis] != 0 ? part[axis] : 1.0F - part[axis];
    }
    const Corner& corner = frame.at(block[0] + static_cast<std::int64_t>(high[0]),
                                    block[1] + static_cast<std::int64_t>(high[1]),
                                    block[2] + static_cast<std::int64_t>(high[2]));
    for (std::size_t p = 0; p < sum.size(); ++p) {
      sum[p] += weight * corner[p];
    }
  }
  return sum;
}

} // namespace

FineDetail::FineDetail(const LayerCrossing& crossing, const Segment& segment, float from, float to)
    : frame_(crossing.noise), from_(from) {
  if (frame_ == nullptr) {
    return;
  }
  constexpr auto side = static_cast<float>(Bricks::side);
  std::array<std::int64_t, 3> block;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    block[axis] = static_cast<std::int64_t>(segment.corner[axis]) / Bricks::side;
  }
  const auto place = [&](float distance) {
    auto part = local(crossing, segment, distance);
    for (float& each : part) {
      each = std::clamp(each / side, 0.0F, 1.0F);
    }
    return between(*frame_, block, part);
  };
  start_ = place(from);
  const Corner end = place(to);
  for (std::size_t p = 0; p < end.size(); ++p) {
    slope_[p] = (end[p] - start_[p]) / std::max(to - from, 1.0e-6F);
  }
}

void FineDetail::at(const SampleRow& distances, float finest, SampleRow& noise) const {
  noise.fill(0.0F);
  for (std::size_t phase = 0; phase < NoiseFrame::phases; ++phase) {
    if (frame_->weights[phase] < 0.02F) {
      continue;
    }
    Lines places;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t p = 3 * phase + axis;
      for (std::size_t n = 0; n < noise.size(); ++n) {
        places[axis][n] = start_[p] + slope_[p] * (distances[n] - from_);
      }
    }
    float size = frame_->size, share = ridge_height * frame_->share * frame_->weights[phase];
    std::uint32_t seed = frame_->seeds[phase] * 8U + first_seed;
    for (int octave = 0; octave < max_octaves && size > finest; ++octave) {
      const float shown = std::min((size / finest - 1.0F) / (whole - 1.0F), 1.0F);
      add_ridges(places, 1.0F / size, seed, share * shown, noise);
      size *= finer;
      share *= roughness;
      seed += 0x10001U;
    }
  }
}

float outline_factor(float edge, float noise, float sharpness) {
  if (edge <= clear) {
    return 0.0F;
  }
  // Noise moves an outline but neither starts smoke in clear air nor holes inside of it.
  const float moved = edge + noise * std::min(6.0F * edge * (1.0F - edge), 1.0F);
  const float inside = std::clamp((moved - 0.5F) * sharpness + 0.5F, 0.0F, 1.0F);
  return inside / edge * std::max(1.0F + body * noise, 0.0F);
}

} // namespace firetwin::volume
