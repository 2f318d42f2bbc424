#include "flow/detail_brush.hpp"

#include "base/interpolation.hpp"
#include "base/perlin.hpp"
#include "base/smoothstep.hpp"
#include "flow/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace firetwin::flow {
namespace {

constexpr float extinction_per_kg = 4000.0F; // m2/kg
constexpr float soft_cut[] = {2.4F, 6.2F}, crisp_cut[] = {5.2F, 6.2F};
constexpr float soft_gain = 1.5F, crisp_gain = 3.5F, veil_gain = 1.0F;
constexpr float soft_reach = 1.5F; // amplitude of soft noise
constexpr float max_noise = 1.2F;  // largest noise assumed when clear voxels are skipped
constexpr float root = 0.06F;      // share of the extinction at the ground
constexpr float root_heights[] = {15.0F, 200.0F};
// Share of `VoxelRegion::log_gain` that moves outlines; the rest thins smoke inside of them.
constexpr float eroding = 0.5F;
// Displacement of `VoxelRegion::log_gain` by eddies that grow with the height above ground, and
// their wavelength over `VoxelRegion::gain_height` (by eye).
constexpr float meandering = 0.9F, meander_size = 0.25F;
constexpr std::uint32_t meander_seed = 0x51U;

} // namespace

Detail::Brush::Brush(const Detail& d, const VoxelRegion& b, DetailOutput& out)
    : detail_(d), brick_(b), out_(out), at_(0.0F, 0.0F, d.shape_),
      noise_(d.settings_.size, b.voxel, d.seeds_), outline_(noise_.outline()) {
  const auto levels = static_cast<std::size_t>(d.shape_.nz + lanes);
  height_.resize(levels);
  level_.resize(levels + 2);
  for (auto& part : drift_) {
    part.resize(levels);
  }
  const auto voxels = static_cast<std::size_t>(whole_lanes(b.shape[2]));
  places_.low.resize(voxels);
  places_.part.resize(voxels);
  voxel_.resize(voxels);
  for (auto* values :
       {&high_up_, &above_, &amount_, &gain_, &vigour_, &cloud_, &reach_, &solid_, &value_}) {
    values->resize(voxels);
  }
}

void Detail::Brush::column(Index i, Index j) {
  if (!move_to(i, j) || !find_levels()) {
    return;
  }
  find_heights();
  find_voxels(i, j);
  if (places_.count > 0) {
    paint_surface();
    find_drift();
    find_amount();
    enqueue();
  }
}

/// Moves to a column; false if it is outside the flow.
bool Detail::Brush::move_to(Index i, Index j) {
  const Detail& d = detail_;
  x_ = brick_.origin[0] + static_cast<double>(i) * brick_.voxel;
  y_ = brick_.origin[1] + static_cast<double>(j) * brick_.voxel;
  column_ = static_cast<std::size_t>(i * brick_.shape[1] + j);
  i_ = i;
  j_ = j;
  const double column = (x_ - d.corner_[0]) / d.spacing_ - 0.5;
  const double row = (y_ - d.corner_[1]) / d.spacing_ - 0.5;
  at_ = ColumnStencil(static_cast<float>(column), static_cast<float>(row), d.shape_);
  return column >= 0.0 && row >= 0.0 && column <= static_cast<double>(d.shape_.nx - 1) &&
         row <= static_cast<double>(d.shape_.ny - 1);
}

/// Finds the levels with visible smoke; false if there are none.
bool Detail::Brush::find_levels() {
  const Index top = detail_.shape_.nz - 1;
  float* amount = level_.data() + 1;
  detail_.amount_.linear(at_, 0, top, amount);
  for (last_ = top; last_ >= 0 && amount[last_] < visible_amount; --last_) {
  }
  for (first_ = 0; first_ < last_ && amount[first_] < visible_amount; ++first_) {
  }
  low_ = std::max(first_ - 2, Index{0});
  high_ = std::min(last_ + 2, top);
  return last_ >= 0;
}

void Detail::Brush::find_heights() {
  detail_.ground_.linear(at_, 0, 0, height_.data());
  const float higher = brick_.surface[column_] - height_[0];
  detail_.heights_.linear(at_, low_, high_, height_.data());
  for (auto k = static_cast<std::size_t>(low_); k <= static_cast<std::size_t>(high_); ++k) {
    height_[k] += higher * detail_.terrain_share_[k];
  }
}

/// Finds the voxels of the column that are requested, above ground and in smoke.
void Detail::Brush::find_voxels(Index i, Index j) {
  const VoxelRegion& b = brick_;
  const auto blocks = b.blocks();
  const std::uint8_t* wanted =
      b.wanted.empty()
          ? nullptr
          : b.wanted.data() +
                (i / VoxelRegion::block * blocks[1] + j / VoxelRegion::block) * blocks[2];
  const auto top = static_cast<std::size_t>(std::min(last_ + 1, high_));
  auto k = static_cast<std::size_t>(std::max(first_ - 1, Index{0}));
  const float ground = b.surface[column_] - static_cast<float>(b.voxel);
  const float bottom = k > 0 ? std::max(height_[k], ground) : ground;
  const double below = std::floor((static_cast<double>(bottom) - b.origin[2]) / b.voxel) - 1.0;
  const double first = std::min(std::max(0.0, below), static_cast<double>(b.shape[2]));
  places_.count = 0;
  for (auto m = static_cast<Index>(first); m < b.shape[2]; ++m) {
    if (wanted != nullptr && wanted[m / VoxelRegion::block] == 0) {
      m += VoxelRegion::block - 1 - m % VoxelRegion::block;
      continue;
    }
    const auto height = static_cast<float>(b.origin[2] + static_cast<double>(m) * b.voxel);
    if (height < bottom) {
      continue;
    }
    while (k + 1 < top && height_[k + 1] < height) {
      ++k;
    }
    const float way = (height - height_[k]) / (height_[k + 1] - height_[k]);
    if (way > 1.0F) {
      break;
    }
    add_voxel(m, height, k, way);
  }
}

/// Adds a voxel if it is in smoke; `way` is its position between two levels, 0 to 1, or negative
/// below the lowest level.
void Detail::Brush::add_voxel(Index voxel, float height, std::size_t k, float way) {
  const float* amount = level_.data() + 1;
  const float held = std::max(way, 0.0F), level = static_cast<float>(k) + held;
  const Index low = std::min(static_cast<Index>(level), detail_.shape_.nz - 2);
  const float part = level - static_cast<float>(low);
  if (lerp(amount[low], amount[low + 1], part) < visible_amount) {
    return;
  }
  const auto n = static_cast<std::size_t>(places_.count++);
  places_.low[n] = static_cast<std::int32_t>(low);
  places_.part[n] = part;
  voxel_[n] = voxel;
  high_up_[n] = height;
  above_[n] = way < 0.0F ? std::max(height - brick_.surface[column_], 0.0F)
                         : lerp(detail_.levels_[k], detail_.levels_[k + 1], held);
}

/// Interpolates values linearly between levels, at the voxels.
void Detail::Brush::interpolate(const Columns& of, std::vector<float>& values) {
  of.linear(at_, low_, high_, level_.data() + 1);
  linear_between(places_, level_.data() + 1, values.data());
}

/// Computes quantities without noise: freshness, and the light of flames.
void Detail::Brush::paint_surface() {
  const Detail& d = detail_;
  const auto count = static_cast<std::size_t>(places_.count);
  interpolate(d.vigour_, vigour_);
  interpolate(d.age_, value_);
  for (std::size_t n = 0; n < count; ++n) {
    cloud_[n] = vigour_[n] * d.condensed_share(high_up_[n]);
    const float fresh =
        (1.0F - cloud_[n]) * smoothstep(d.settings_.ages[1], d.settings_.ages[0], value_[n]);
    if (fresh > 0.0F) {
      out_.set(SparseSmoke::fresh, place(n), fresh);
    }
  }
  if (out_.glows()) {
    interpolate(d.glow_, value_);
    for (std::size_t n = 0; n < count; ++n) {
      out_.set(SparseSmoke::glow, place(n), value_[n]);
    }
  }
}

/// Computes the amount of smoke before noise, and the amplitude of the noise.
void Detail::Brush::find_amount() {
  const auto count = static_cast<std::size_t>(places_.count);
  interpolate(detail_.reach_, reach_);
  interpolate(detail_.solid_, solid_);
  float* levels = level_.data() + 1;
  detail_.amount_.cubic(at_, low_, high_, levels);
  levels[low_ - 1] = levels[low_];
  levels[high_ + 1] = levels[high_];
  cubic_between(places_, levels, amount_.data());
  for (std::size_t n = 0; n < count; ++n) {
    gain_[n] = eroding * log_gain(n);
    amount_[n] = std::max(amount_[n], 0.0F) + cloud_amount * cloud_[n] + gain_[n];
    reach_[n] = lerp(soft_reach, reach_[n], vigour_[n]);
  }
}

/// Finds the drift on the levels of the column.
void Detail::Brush::find_drift() {
  for (std::size_t p = 0; p < Drift::parts; ++p) {
    if (detail_.shows(p / 3)) {
      detail_.drift_[p].linear(at_, low_, high_, drift_[p].data());
    }
  }
}

/// Interpolates a part of the drift at a voxel, m.
float Detail::Brush::moved(std::size_t part, std::size_t n) const {
  const auto low = static_cast<std::size_t>(places_.low[n]);
  return lerp(drift_[part][low], drift_[part][low + 1], places_.part[n]);
}

/// Returns the horizontal displacement of smoke near the ground by eddies, m. It travels with the
/// air.
std::array<float, 2> Detail::Brush::meander(std::size_t n) const {
  std::array<float, 2> shift{};
  const double size = static_cast<double>(meander_size * brick_.gain_height);
  for (std::size_t p = 0; p < Drift::phases; ++p) {
    if (!detail_.shows(p)) {
      continue;
    }
    const auto at = [&](double place, std::size_t part) {
      return static_cast<float>((place - static_cast<double>(moved(3 * p + part, n))) / size);
    };
    const float x = at(x_, 0), y = at(y_, 1), z = at(static_cast<double>(above_[n]), 2);
    for (std::size_t axis = 0; axis < shift.size(); ++axis) {
      const auto seed = detail_.seeds_[p] * 8U + meander_seed + static_cast<std::uint32_t>(axis);
      shift[axis] += detail_.weights_[p] * meandering * above_[n] * perlin_at(x, y, z, seed);
    }
  }
  return shift;
}

/// Interpolates the logarithm of the factor on the smoke at a voxel.
float Detail::Brush::log_gain(std::size_t n) const {
  const VoxelRegion& b = brick_;
  const float above = above_[n], part = above / b.gain_height;
  if (b.log_gain.empty() || part > 2.5F) {
    return 0.0F;
  }
  const std::array<float, 2> shift = meander(n);
  std::array<Index, 2> low{};
  std::array<float, 2> way{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto at = static_cast<float>(axis == 0 ? i_ : j_) -
                    (b.lean[axis] * above + shift[axis]) / static_cast<float>(b.voxel);
    const float held = std::clamp(at, 0.0F, static_cast<float>(b.shape[axis] - 1));
    low[axis] = std::min(static_cast<Index>(held), std::max(b.shape[axis] - 2, Index{0}));
    way[axis] = held - static_cast<float>(low[axis]);
  }
  const auto value = [&](Index i, Index j) {
    const Index x = std::min(i, b.shape[0] - 1), y = std::min(j, b.shape[1] - 1);
    return b.log_gain[static_cast<std::size_t>(x * b.shape[1] + y)];
  };
  const auto [i, j] = low;
  return std::exp(-part * part) * lerp(lerp(value(i, j), value(i, j + 1), way[1]),
                                       lerp(value(i + 1, j), value(i + 1, j + 1), way[1]), way[0]);
}

/// Queues voxels that some noise could make visible, and paints them as soon as they fill a Row.
void Detail::Brush::enqueue() {
  for (std::size_t n = 0; n < static_cast<std::size_t>(places_.count); ++n) {
    const float thin = vigour_[n] * (1.0F - solid_[n]);
    const float low = lerp(soft_cut[0], crisp_cut[0], vigour_[n]);
    if (amount_[n] + max_noise * reach_[n] >= low ||
        (thin >= 0.02F && amount_[n] + max_noise * soft_reach >= soft_cut[0])) {
      wait_for(n);
    }
  }
}

void Detail::Brush::wait_for(std::size_t n) {
  PendingVoxels& w = pending_;
  const std::size_t lane = w.count++;
  w.place[lane] = place(n);
  w.share[lane] = brick_.share[column_];
  w.above[lane] = above_[n];
  w.amount[lane] = amount_[n];
  w.gain[lane] = gain_[n];
  w.reach[lane] = reach_[n];
  w.vigour[lane] = vigour_[n];
  w.solid[lane] = solid_[n];
  for (std::size_t p = 0; p < Drift::phases; ++p) {
    if (detail_.shows(p)) {
      w.origin[p][0][lane] = x_ - static_cast<double>(moved(3 * p, n));
      w.origin[p][1][lane] = y_ - static_cast<double>(moved(3 * p + 1, n));
      w.origin[p][2][lane] = static_cast<double>(above_[n] - moved(3 * p + 2, n));
    }
  }
  if (w.count == w.place.size()) {
    finish();
  }
}

void Detail::Brush::finish() {
  PendingVoxels& w = pending_;
  Row raise{}, noise;
  for (std::size_t p = 0; p < Drift::phases && w.count > 0; ++p) {
    if (detail_.shows(p)) {
      noise_.at(w.origin[p], p, w.vigour, noise);
      for (std::size_t lane = 0; lane < noise.size(); ++lane) {
        raise[lane] += detail_.weights_[p] * noise[lane];
      }
    }
  }
  for (std::size_t lane = 0; lane < w.count; ++lane) {
    const Painted painted = paint(lane, raise[lane]);
    out_.set(SparseSmoke::density, w.place[lane], w.share[lane] * painted.extinction);
    out_.set(SparseSmoke::veil, w.place[lane], w.share[lane] * painted.veil);
    out_.set(SparseSmoke::edge, w.place[lane], painted.edge);
  }
  w.count = 0;
}

Detail::Brush::Painted Detail::Brush::paint(std::size_t n, float raise) const {
  const float v = pending_.vigour[n], amount = pending_.amount[n], solid = pending_.solid[n];
  // Exponentials without effect are skipped: they would take a twelfth of the run time.
  const auto dense = [](float held, float left) {
    return left > 0.0F ? std::exp(held) * left : 0.0F;
  };
  const float low = lerp(soft_cut[0], crisp_cut[0], v), high = lerp(soft_cut[1], crisp_cut[1], v);
  const float raised = amount + pending_.reach[n] * raise, veiled = amount + soft_reach * raise;
  const float held = lerp(raised, std::max(amount, lerp(core[0], core[1], solid)), v);
  // An outline has at least the width of some voxels, and is a line so that it can be sharpened.
  const float middle = 0.5F * (low + high),
              width = std::max(high - low, v * pending_.reach[n] * outline_);
  const float position = (raised - middle) / width + 0.5F;
  const float inside = std::clamp(position, 0.0F, 1.0F);
  const float gain = lerp(soft_gain, crisp_gain, v);
  const float veil = lerp(
      dense(held, gain * smoothstep(0.0F, 1.0F, position)),
      dense(veiled, veil_gain * (1.0F - solid) * smoothstep(soft_cut[0], soft_cut[1], veiled)), v);
  const float rooted = lerp(
      root, 1.0F,
      smoothstep(root_heights[0], root_heights[1], pending_.above[n] / detail_.settings_.scale));
  const DetailSettings& settings = detail_.settings_;
  const float eroded = pending_.gain[n];
  const float placed = eroded == 0.0F ? 1.0F : std::exp(eroded * (1.0F - eroding) / eroding);
  const float full =
      detail_.unit_ * extinction_per_kg * static_cast<float>(settings.opacity) * rooted * placed;
  const auto level_off = [&](float all) {
    return all > 0.0F
               ? settings.max_extinction * (1.0F - std::exp(-full * all / settings.max_extinction))
               : 0.0F;
  };
  // Billows level off before their outline: otherwise it would be a step in thick smoke.
  const float soft = level_off(veil),
              billows = v * inside * level_off(dense(held, inside > 0.0F ? gain : 0.0F));
  return {soft + billows, std::clamp(position, -1.0F, 2.0F) + 1.0F, soft};
}

SparseSmoke Detail::paint(const VoxelRegion& b, float min_extinction) const {
  const auto columns = static_cast<std::size_t>(b.shape[0] * b.shape[1]);
  const auto [nx, ny, nz] = b.blocks();
  const auto blocks = static_cast<std::size_t>(nx * ny * nz);
  if (b.surface.size() != columns || b.share.size() != columns ||
      (!b.wanted.empty() && b.wanted.size() != blocks) ||
      (!b.log_gain.empty() && b.log_gain.size() != columns)) {
    throw std::invalid_argument(
        "surface, share, wanted and log_gain must have the shape of the voxel region");
  }
  SparseSmoke smoke({b.shape[0], b.shape[1], b.shape[2]}, b.voxel, b.origin, glows());
  smoke.set_noise(find_noise(b, smoke.blocks()));
  constexpr Index side = SparseSmoke::side;
  each(smoke.blocks()[0], [&](Index block_i) {
    DetailOutput out(smoke);
    Brush brush(*this, b, out);
    for (Index block_j = 0; block_j < smoke.blocks()[1]; ++block_j) {
      for (Index i = block_i * side; i < std::min((block_i + 1) * side, b.shape[0]); ++i) {
        for (Index j = block_j * side; j < std::min((block_j + 1) * side, b.shape[1]); ++j) {
          if (b.share[static_cast<std::size_t>(i * b.shape[1] + j)] > 0.0F) {
            brush.column(i, j);
          }
        }
      }
      brush.finish();
      out.move_to(smoke, block_i, block_j, min_extinction);
    }
  });
  return smoke;
}

} // namespace firetwin::flow
