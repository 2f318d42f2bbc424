#include "volume/fine_detail.hpp"

#include "base/clones.hpp"
#include "base/interpolation.hpp"
#include "base/perlin.hpp"

#include <algorithm>
#include <cmath>

namespace firetwin::volume {
namespace {

constexpr auto finer = static_cast<float>(NoiseFrame::finer);
constexpr float mean_ridge = 0.25F; // of |Perlin noise|
constexpr float ridge_height = 1.2F;
constexpr float whole =
    1.6F; // wavelength over the finest at which an octave has its full amplitude
constexpr int max_octaves = 5;
constexpr std::uint32_t first_seed = 7; // octave number that is not painted
constexpr float body_noise = 0.8F;      // amplitude of noise inside of the outline
constexpr float clear = 1.0e-3F;

using Lines = std::array<SampleRow, 3>;

FIRETWIN_CLONES("avx512f", "avx2")
void add_ridges(const Lines& places, float scale, std::uint32_t seed, const SampleRow& share,
                SampleRow& noise) {
  for (std::size_t n = 0; n < noise.size(); ++n) {
    const float found =
        perlin_at(places[0][n] * scale, places[1][n] * scale, places[2][n] * scale, seed);
    noise[n] += share[n] * (mean_ridge - std::abs(found));
  }
}

/// Rotates a place by a fixed angle about an oblique axis: octaves do not share a lattice, and none
/// is level.
std::array<float, 3> turned(const std::array<float, 3>& v) {
  return {0.80F * v[1] + 0.60F * v[2], -0.80F * v[0] + 0.36F * v[1] - 0.48F * v[2],
          -0.60F * v[0] - 0.48F * v[1] + 0.64F * v[2]};
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

void FineDetail::at(const SampleRow& distances, const SampleRow& finest, SampleRow& noise) const {
  noise.fill(0.0F);
  const float least = *std::min_element(finest.begin(), finest.end());
  for (std::size_t phase = 0; phase < NoiseFrame::phases; ++phase) {
    if (frame_->weights[phase] < 0.02F) {
      continue;
    }
    std::array<float, 3> start, slope;
    std::copy_n(start_.begin() + static_cast<std::ptrdiff_t>(3 * phase), 3, start.begin());
    std::copy_n(slope_.begin() + static_cast<std::ptrdiff_t>(3 * phase), 3, slope.begin());
    float size = frame_->size, share = ridge_height * frame_->share * frame_->weights[phase];
    std::uint32_t seed = frame_->seeds[phase] * 8U + first_seed;
    for (int octave = 0; octave < max_octaves && size > least; ++octave) {
      SampleRow shown;
      for (std::size_t n = 0; n < shown.size(); ++n) {
        shown[n] = share * std::clamp((size / finest[n] - 1.0F) / (whole - 1.0F), 0.0F, 1.0F);
      }
      start = turned(start);
      slope = turned(slope);
      Lines places;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t n = 0; n < noise.size(); ++n) {
          places[axis][n] = start[axis] + slope[axis] * (distances[n] - from_);
        }
      }
      add_ridges(places, 1.0F / size, seed, shown, noise);
      size *= finer;
      share *= NoiseFrame::roughness;
      seed += 0x10001U;
    }
  }
}

float Outline::extinction(float density, float noise, float sharpness, float part) const {
  const float body = std::max(1.0F + body_noise * noise, 0.0F);
  if (share <= clear) {
    return density + (body * veil - density) * part;
  }
  // Noise moves an outline but neither starts smoke in clear air nor holes inside of it.
  const float reach = std::clamp(1.5F - std::abs(2.0F * position - 3.0F), 0.0F, 1.0F);
  const float inside = std::clamp((position + reach * noise - 1.5F) * sharpness + 0.5F, 0.0F, 1.0F);
  const float drawn = body * (veil + (density - veil) * inside / share);
  return density + (drawn - density) * part;
}

} // namespace firetwin::volume
