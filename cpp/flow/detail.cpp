#include "flow/detail.hpp"

#include "base/catmull_rom.hpp"
#include "base/smoothstep.hpp"
#include "flow/between.hpp"
#include "flow/noise.hpp"
#include "flow/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace firetwin::flow {
namespace {

constexpr float per_kg = 4000.0F;                // m2/kg
constexpr float unit = 1.0e-9F;                  // kg/m3
constexpr float least = 1.2F;                    // amount without any smoke to see
constexpr float lively_rise[] = {0.4F, 2.5F};    // m/s
constexpr float lively_warmth[] = {0.12F, 0.9F}; // K
constexpr float lively_age = 420.0F;             // s
constexpr float soft_cut[] = {2.4F, 6.2F}, crisp_cut[] = {5.2F, 6.2F};
constexpr float soft_gain = 1.5F, crisp_gain = 3.5F, veil_gain = 1.0F;
constexpr float soft_reach = 1.5F; // of noise in the amount
constexpr float crisp_reach[] = {0.8F, 7.0F};
constexpr float whole[] = {5.5F,
                           8.5F}; // amount near by that noise of least and of full reach tears
constexpr float lump_slope = 1.4F;
constexpr float core[] = {6.3F, 8.0F}; // of a vigorous core at least, in thin and in thick smoke
constexpr float cloud_depth = 500.0F;  // m above condensation over which smoke turns to cloud
constexpr float cloud_amount = 2.5F;   // of droplets in the amount
constexpr float cloud_ages[] = {600.0F, 1600.0F}; // s, between which droplets evaporate
constexpr float roughness = 0.7F;
constexpr double finer = 0.47;
constexpr int lump_octaves = 3, most_octaves = 7;
constexpr float root = 0.12F; // share of the extinction at the ground
constexpr float root_heights[] = {10.0F, 130.0F};
constexpr float terrain_fade = 1000.0F; // m over which levels forget ground finer than the flow's

float ramp(float low, float high, float x) {
  return std::clamp((x - low) / (high - low), 0.0F, 1.0F);
}

/// Cubic (Catmull and Rom 1974) between the middles of cells, constant outside.
float cubic(const std::vector<float>& values, const Shape& s, float x, float y, float z) {
  const std::array<float, 3> at{x, y, z};
  const std::array<Index, 3> count{s.nx, s.ny, s.nz};
  std::array<Index, 3> low{};
  std::array<std::array<float, 4>, 3> weight{};
  for (std::size_t a = 0; a < 3; ++a) {
    const float held = std::clamp(at[a], 0.0F, static_cast<float>(count[a] - 1));
    low[a] = static_cast<Index>(held);
    weight[a] = catmull_rom(held - static_cast<float>(low[a]));
  }
  std::array<Index, 4> column{};
  for (Index i = 0; i < 4; ++i) {
    column[static_cast<std::size_t>(i)] = std::clamp(low[0] + i - 1, Index{0}, s.nx - 1);
  }
  float sum = 0.0F;
  for (Index k = 0; k < 4; ++k) {
    const Index level = std::clamp(low[2] + k - 1, Index{0}, s.nz - 1);
    for (Index j = 0; j < 4; ++j) {
      const Index row = std::clamp(low[1] + j - 1, Index{0}, s.ny - 1);
      const float* v = values.data() + (level * s.ny + row) * s.nx;
      const auto& w = weight[0];
      sum +=
          weight[2][static_cast<std::size_t>(k)] * weight[1][static_cast<std::size_t>(j)] *
          (v[column[0]] * w[0] + v[column[1]] * w[1] + v[column[2]] * w[2] + v[column[3]] * w[3]);
    }
  }
  return sum;
}

void check(const Moment& m) {
  const std::size_t n = m.shape.size();
  const auto plane = static_cast<std::size_t>(m.shape.ny * m.shape.nx);
  const bool fits = m.levels.size() == static_cast<std::size_t>(m.shape.nz) &&
                    m.heights.size() == n && m.ground.size() == plane && m.smoke.size() == n &&
                    m.age.size() == n && m.rise.size() == n && m.warmth.size() == n &&
                    (m.glow.empty() || m.glow.size() == n) && m.drift.size() == Drift::parts * n;
  if (!fits || n == 0 || m.shape.nz < 2) {
    throw std::invalid_argument(
        "the moment's arrays must be of one shape, with two levels at least");
  }
}

} // namespace

/// A column of voxels on the flow's grid, and what its neighbours leave behind.
struct Detail::Column {
  double x, y;               ///< m
  double finest;             ///< least size of lumps, m
  float share, surface;      ///< of the brick
  float column, row;         ///< fractional, on the flow's grid
  std::size_t nearest;       ///< cell of the lowest level
  std::vector<float> height; ///< [nz] of cells' middles here, m
  std::array<std::array<Worley, lump_octaves>, Drift::phases> lumps;
};

Detail::Detail(const Moment& m, const Look& look)
    : shape_(m.shape), spacing_(m.spacing), corner_(m.corner),
      levels_(m.levels.begin(), m.levels.end()), heights_(m.heights.begin(), m.heights.end()),
      ground_(m.ground.begin(), m.ground.end()), age_(m.age.begin(), m.age.end()),
      glow_(m.glow.begin(), m.glow.end()), weights_(m.weights), look_(look) {
  check(m);
  for (std::size_t p = 0; p < Drift::phases; ++p) {
    seeds_[p] = (look.seed * 2U + static_cast<std::uint32_t>(p)) * 977U +
                static_cast<std::uint32_t>(m.turns[p]);
  }
  amount_.resize(shape_.size());
  each(shape_.nz, [&](Index k) {
    const auto plane = static_cast<std::size_t>(shape_.ny * shape_.nx);
    for (std::size_t n = static_cast<std::size_t>(k) * plane, end = n + plane; n < end; ++n) {
      amount_[n] = std::log(std::max(m.smoke[n] / unit, 1.0F));
    }
  });
  find_vigour(m);
  find_reach();
  find_smoky();
  drift_.resize(m.drift.size());
  std::vector<float> part(shape_.size());
  for (std::size_t p = 0; p < Drift::parts; ++p) {
    for (std::size_t n = 0; n < part.size(); ++n) {
      part[n] = m.drift[n * Drift::parts + p];
    }
    blur(part, shape_, look.blur);
    for (std::size_t n = 0; n < part.size(); ++n) {
      drift_[n * Drift::parts + p] = part[n];
    }
  }
}

/// How much of vapour that rose to a height has condensed, 0 to 1.
float Detail::capped(float height) const {
  return smoothstep(look_.condensation, look_.condensation + cloud_depth, height);
}

void Detail::find_vigour(const Moment& m) {
  std::vector<float> near = amount_, dense = amount_;
  spread(near, shape_, 2);
  blur(dense, shape_, {0.7, 0.7, 0.7});
  spread(dense, shape_, 2);
  vigour_.resize(shape_.size());
  for (std::size_t n = 0; n < vigour_.size(); ++n) {
    const float cap = capped(heights_[n]);
    const float lively = ramp(lively_rise[0], lively_rise[1], m.rise[n]) +
                         ramp(lively_warmth[0], lively_warmth[1], m.warmth[n]) +
                         0.8F * ramp(lively_age, 0.0F, m.age[n]) +
                         cap * ramp(cloud_ages[1], cloud_ages[0], m.age[n]);
    const float droplets = cloud_amount * cap;
    vigour_[n] = std::max(std::min(lively, 1.0F) * ramp(5.0F, 6.8F, near[n] + droplets),
                          ramp(6.0F, 7.6F, dense[n]));
  }
  blur(vigour_, shape_, {1.0, 1.0, 1.0});
  for (float& vigour : vigour_) {
    vigour = smoothstep(0.1F, 0.7F, vigour); // few places are neither: half a lump is a blur
  }
}

void Detail::find_reach() {
  const Shape& s = shape_;
  reach_.resize(s.size());
  std::vector<float> square(s.size());
  each(s.nz, [&](Index k) {
    const Index below = std::max(k - 1, Index{0}), above = std::min(k + 1, s.nz - 1);
    const float gap = std::max(
        levels_[static_cast<std::size_t>(above)] - levels_[static_cast<std::size_t>(below)], 1.0F);
    for (Index j = 0; j < s.ny; ++j) {
      const Index front = std::max(j - 1, Index{0}), back = std::min(j + 1, s.ny - 1);
      for (Index i = 0; i < s.nx; ++i) {
        const auto value = [&](Index kk, Index jj, Index ii) {
          return amount_[static_cast<std::size_t>((kk * s.ny + jj) * s.nx + ii)];
        };
        const Index left = std::max(i - 1, Index{0}), right = std::min(i + 1, s.nx - 1);
        const auto cells = [&](Index a, Index b) {
          return static_cast<float>(std::max(b - a, Index{1})) * static_cast<float>(spacing_);
        };
        const float dx = (value(k, j, right) - value(k, j, left)) / cells(left, right);
        const float dy = (value(k, back, i) - value(k, front, i)) / cells(front, back);
        const float dz = (value(above, j, i) - value(below, j, i)) / gap;
        const auto n = static_cast<std::size_t>((k * s.ny + j) * s.nx + i);
        const float slope = amount_[n] > 0.5F ? std::sqrt(dx * dx + dy * dy + dz * dz) : 0.0F;
        reach_[n] = slope;
        square[n] = slope * slope;
      }
    }
  });
  blur(square, shape_, {2.0, 2.0, 2.0});
  blur(reach_, shape_, {2.0, 2.0, 2.0});
  std::vector<float> densest = amount_;
  spread(densest, shape_, 2);
  blur(densest, shape_, {1.0, 1.0, 1.0});
  solid_.resize(s.size());
  for (std::size_t n = 0; n < reach_.size(); ++n) {
    const float steep = square[n] / std::max(reach_[n], 1.0e-6F);
    const float thick = densest[n] + cloud_amount * capped(heights_[n]);
    const float most = mix(crisp_reach[0], crisp_reach[1], ramp(whole[0], whole[1], thick));
    solid_[n] = ramp(core[0], core[1], thick);
    reach_[n] =
        std::clamp(lump_slope * static_cast<float>(look_.size) * steep, crisp_reach[0], most);
  }
}

void Detail::find_smoky() {
  std::vector<float> near = amount_;
  spread(near, shape_, 1);
  smoky_.resize(near.size());
  std::transform(near.begin(), near.end(), smoky_.begin(),
                 [](float amount) { return static_cast<std::uint8_t>(amount >= least); });
}

bool Detail::smoky(const Column& c, float level) const {
  const auto plane = static_cast<std::size_t>(shape_.ny * shape_.nx);
  return smoky_[static_cast<std::size_t>(std::lround(level)) * plane + c.nearest] != 0;
}

/// False outside of the flow.
bool Detail::begin(Column& c) const {
  const double column = (c.x - corner_[0]) / spacing_ - 0.5;
  const double row = (c.y - corner_[1]) / spacing_ - 0.5;
  if (column < 0.0 || row < 0.0 || column > static_cast<double>(shape_.nx - 1) ||
      row > static_cast<double>(shape_.ny - 1)) {
    return false;
  }
  c.nearest = static_cast<std::size_t>(std::lround(row) * shape_.nx + std::lround(column));
  c.column = static_cast<float>(column);
  c.row = static_cast<float>(row);
  const Between<1> ground(shape_.nx, shape_.ny, 1, ground_.data());
  const float higher = c.surface - ground.at(c.column, c.row, 0.0F)[0];
  const Between<1> heights(shape_.nx, shape_.ny, shape_.nz, heights_.data());
  c.height.resize(levels_.size());
  for (std::size_t k = 0; k < levels_.size(); ++k) {
    c.height[k] = heights.at(c.column, c.row, static_cast<float>(k))[0] +
                  higher * std::exp(-levels_[k] / terrain_fade);
  }
  return true;
}

float Detail::lumps(Column& column, const Vector& place, std::size_t phase, float vigour) const {
  float crisp = 0.0F, soft = 0.0F, share = 1.0F;
  double size = look_.size;
  for (int octave = 0; octave < most_octaves && size > column.finest; ++octave) {
    const std::uint32_t own = seeds_[phase] * 8U + static_cast<std::uint32_t>(octave);
    const auto a = static_cast<float>(place[0] / size), b = static_cast<float>(place[1] / size),
               c = static_cast<float>(place[2] / size);
    const bool round = octave < lump_octaves;
    const float smooth = vigour < 0.98F || !round ? perlin(a, b, c, own) : 0.0F;
    soft += share * 0.9F * smooth;
    if (vigour > 0.02F) {
      crisp += share *
               (round ? 1.25F * (0.49F - column.lumps[phase][static_cast<std::size_t>(octave)].at(
                                             a, b, c, own))
                      : 0.6F * (0.5F - 2.0F * std::abs(smooth)));
    }
    share *= roughness;
    size *= finer;
  }
  return mix(soft, crisp, vigour);
}

float Detail::noise(Column& c, float level, float above, float vigour) const {
  const Between<Drift::parts> drift(shape_.nx, shape_.ny, shape_.nz, drift_.data());
  const auto d = drift.at(c.column, c.row, level);
  float sum = 0.0F;
  for (std::size_t p = 0; p < Drift::phases; ++p) {
    if (weights_[p] > 0.02F) {
      const Vector place{c.x - static_cast<double>(d[3 * p]),
                         c.y - static_cast<double>(d[3 * p + 1]),
                         static_cast<double>(above - d[3 * p + 2])};
      sum += weights_[p] * lumps(c, place, p, vigour);
    }
  }
  return sum;
}

float Detail::vigour(const Column& c, float level) const {
  return Between<1>(shape_.nx, shape_.ny, shape_.nz, vigour_.data()).at(c.column, c.row, level)[0];
}

/// At a fractional level, `above` m over the ground; 0 where the smoke ends.
float Detail::extinction(Column& c, float level, float above, float v, float cloud) const {
  const float amount =
      std::max(cubic(amount_, shape_, c.column, c.row, level), 0.0F) + cloud_amount * cloud;
  const Between<1> reaches(shape_.nx, shape_.ny, shape_.nz, reach_.data());
  const float reach = mix(soft_reach, reaches.at(c.column, c.row, level)[0], v);
  const float low = mix(soft_cut[0], crisp_cut[0], v), high = mix(soft_cut[1], crisp_cut[1], v);
  const float solid =
      Between<1>(shape_.nx, shape_.ny, shape_.nz, solid_.data()).at(c.column, c.row, level)[0];
  const float thin = v * (1.0F - solid);
  if (amount + 1.2F * reach < low && (thin < 0.02F || amount + 1.2F * soft_reach < soft_cut[0])) {
    return 0.0F;
  }
  const float raise = noise(c, level, above, v);
  const auto dense = [&](float cut_low, float cut_high, float raised, float held, float gain) {
    return std::exp(held) * gain * smoothstep(cut_low, cut_high, raised);
  };
  const float raised = amount + reach * raise, veiled = amount + soft_reach * raise;
  const float held = mix(raised, std::max(amount, mix(core[0], core[1], solid)), v);
  const float lumps = dense(low, high, raised, held, mix(soft_gain, crisp_gain, v));
  const float veil = thin * dense(soft_cut[0], soft_cut[1], veiled, veiled, veil_gain);
  const float rooted = mix(root, 1.0F, smoothstep(root_heights[0], root_heights[1], above));
  const float full = (lumps + veil) * unit * per_kg * static_cast<float>(look_.opacity) * rooted;
  return look_.thickest * (1.0F - std::exp(-full / look_.thickest));
}

/// One column of the brick.
void Detail::paint_column(Column& c, const Brick& b, Index i, Index j, const Painted& out) const {
  const Between<1> amounts(shape_.nx, shape_.ny, shape_.nz, amount_.data());
  const Between<1> ages(shape_.nx, shape_.ny, shape_.nz, age_.data());
  const Between<1> glows(shape_.nx, shape_.ny, shape_.nz, glow_.data());
  const auto blocks = b.blocks();
  const std::uint8_t* wanted =
      b.wanted.empty()
          ? nullptr
          : b.wanted.data() + (i / Brick::block * blocks[1] + j / Brick::block) * blocks[2];
  const auto first = static_cast<std::size_t>((i * b.shape[1] + j) * b.shape[2]);
  std::size_t k = 0;
  for (Index m = 0; m < b.shape[2]; ++m) {
    if (wanted != nullptr && wanted[m / Brick::block] == 0) {
      m += Brick::block - 1 - m % Brick::block;
      continue;
    }
    const auto height = static_cast<float>(b.origin[2] + static_cast<double>(m) * b.voxel);
    if (height < c.surface - static_cast<float>(b.voxel)) {
      continue;
    }
    while (k + 2 < c.height.size() && c.height[k + 1] < height) {
      ++k;
    }
    const float part = (height - c.height[k]) / (c.height[k + 1] - c.height[k]);
    if (part > 1.0F) {
      break;
    }
    const float held = std::max(part, 0.0F), level = static_cast<float>(k) + held;
    if (!smoky(c, level) || amounts.at(c.column, c.row, level)[0] < least) {
      continue;
    }
    const float above =
        part < 0.0F ? std::max(height - c.surface, 0.0F) : mix(levels_[k], levels_[k + 1], held);
    const std::size_t n = first + static_cast<std::size_t>(m);
    const float lively = vigour(c, level);
    const float cloud = lively * capped(height);
    out.density[n] = c.share * extinction(c, level, above, lively, cloud);
    out.fresh[n] = (1.0F - cloud) *
                   smoothstep(look_.ages[1], look_.ages[0], ages.at(c.column, c.row, level)[0]);
    if (!out.glow.empty()) {
      out.glow[n] = glows.at(c.column, c.row, level)[0];
    }
  }
}

void Detail::paint(const Brick& b, const Painted& out) const {
  const auto columns = static_cast<std::size_t>(b.shape[0] * b.shape[1]);
  const std::size_t count = columns * static_cast<std::size_t>(b.shape[2]);
  const auto [nx, ny, nz] = b.blocks();
  const auto blocks = static_cast<std::size_t>(nx * ny * nz);
  if (out.density.size() != count || out.fresh.size() != count || b.surface.size() != columns ||
      b.share.size() != columns || (!b.wanted.empty() && b.wanted.size() != blocks) ||
      out.glow.size() != (glow_.empty() ? 0 : count)) {
    throw std::invalid_argument(
        "surface, share, what is wanted and what is painted must have the brick's shape");
  }
  each(b.shape[0], [&](Index i) {
    Column c;
    c.finest = 1.7 * b.voxel;
    c.x = b.origin[0] + static_cast<double>(i) * b.voxel;
    for (Index j = 0; j < b.shape[1]; ++j) {
      const auto column = static_cast<std::size_t>(i * b.shape[1] + j);
      c.y = b.origin[1] + static_cast<double>(j) * b.voxel;
      c.share = b.share[column];
      c.surface = b.surface[column];
      if (c.share > 0.0F && begin(c)) {
        paint_column(c, b, i, j, out);
      }
    }
  });
}

} // namespace firetwin::flow
