#include "flames/tiles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace firetwin::flames {
namespace {

constexpr float spindle_cell = 8.0F; // m
constexpr float swing = 0.4F; // reach of swaying and eddies in flame lengths, at most `most_swing`
constexpr float most_swing = 6.0F; // m
constexpr float overshoot = 0.05F; // cells by which steps may enter one with flames, for progress
constexpr float outside = 10.0F;   // m, step outside of all squares
constexpr float crown_sway = 1.5F; // m

std::int64_t tiles_of(std::int64_t cells) {
  return (cells + FlameTiles::side - 1) / FlameTiles::side;
}

/// Returns the time that gas takes to rise to a height (m) from the ground, s.
double flight_time(double height, double launch, double acceleration) {
  return (std::sqrt(launch * launch + 2.0 * acceleration * height) - launch) / acceleration;
}

/// Interpolates linearly within a cell.
float interpolate_cell(const std::vector<float>& values, std::int64_t columns, std::int64_t row,
                       std::int64_t column, float up, float right) {
  const float* low = values.data() + row * columns + column;
  const float* high = low + columns;
  const float a = low[0] + (low[1] - low[0]) * right, b = high[0] + (high[1] - high[0]) * right;
  return a + (b - a) * up;
}

} // namespace

FlameTiles::FlameTiles(std::span<const FlameSquare> squares, std::span<const Spindle> spindles,
                       const std::array<double, 2>& wind, double launch, double acceleration,
                       const Vector& origin)
    : spindles_(spindles.begin(), spindles.end()) {
  for (const FlameSquare& square : squares) {
    add_square(square, origin);
  }
  for (Spindle& each : spindles_) {
    each.x -= static_cast<float>(origin[0]);
    each.y -= static_cast<float>(origin[1]);
    each.z -= static_cast<float>(origin[2]);
  }
  constexpr float far = std::numeric_limits<float>::max();
  bounds_ = {far, -far, far, -far};
  heights_ = {far, -far};
  bound_tiles(wind, launch, acceleration);
  list_spindles(wind, launch, acceleration);
  if (!levels_.empty()) { // the coarsest contains all others
    const Level& all = levels_.back();
    const float wide = static_cast<float>(all.columns - 1) * all.spacing,
                deep = static_cast<float>(all.rows - 1) * all.spacing;
    bounds_ = {std::max(bounds_[0], all.x), std::min(bounds_[1], all.x + wide),
               std::max(bounds_[2], all.y), std::min(bounds_[3], all.y + deep)};
  }
}

void FlameTiles::add_square(const FlameSquare& square, const Vector& origin) {
  const auto [rows, columns] = square.shape;
  const auto cells = static_cast<std::size_t>(rows * columns);
  if (rows < 2 || columns < 2 || square.length.size() != cells || square.ground.size() != cells ||
      !(square.spacing > 0.0)) {
    throw std::invalid_argument("length and ground of a square need one shape of at least 2 x 2");
  }
  Level made{{square.length.begin(), square.length.end()},
             {square.ground.begin(), square.ground.end()},
             rows,
             columns,
             tiles_of(rows),
             tiles_of(columns),
             static_cast<float>(square.corner[0] - origin[0]),
             static_cast<float>(square.corner[1] - origin[1]),
             static_cast<float>(square.spacing),
             static_cast<float>(1.0 / square.spacing),
             {},
             {},
             {},
             {}};
  for (float& height : made.ground) {
    height -= static_cast<float>(origin[2]);
  }
  constexpr float inside = 0.999F; // of the last cell: coordinates are rounded
  made.end = {made.x + (static_cast<float>(columns - 2) + inside) * made.spacing,
              made.y + (static_cast<float>(rows - 2) + inside) * made.spacing};
  const auto tiles = static_cast<std::size_t>(made.tile_rows * made.tile_columns);
  made.top.assign(tiles, none);
  made.longest.assign(tiles, 0.0F);
  made.rooted.assign(tiles, 0.0F);
  levels_.push_back(std::move(made));
}

/// Returns the finest level around a place; null outside.
const FlameTiles::Level* FlameTiles::level(float x, float y) const {
  for (const Level& each : levels_) {
    if (each.contains(x, y)) {
      return &each;
    }
  }
  return nullptr;
}

/// Interpolates in the level of the first place, or in their own levels if it does not contain all.
void FlameTiles::interpolate_lanes(std::vector<float> Level::* values, float outside,
                                   const Lanes& x, const Lanes& y, Lanes& out) const {
  const Level* first = level(x[0], y[0]);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const Level* at = first;
    if (at == nullptr || !at->contains(x[lane], y[lane])) {
      at = level(x[lane], y[lane]);
    }
    if (at == nullptr) {
      out[lane] = outside;
      continue;
    }
    const float column = (x[lane] - at->x) * at->inverse, row = (y[lane] - at->y) * at->inverse;
    const auto i = static_cast<std::int32_t>(row), j = static_cast<std::int32_t>(column);
    out[lane] = interpolate_cell(at->*values, at->columns, i, j, row - static_cast<float>(i),
                                 column - static_cast<float>(j));
  }
}

void FlameTiles::ground(const Lanes& x, const Lanes& y, Lanes& out) const {
  interpolate_lanes(&Level::ground, none, x, y, out);
}

void FlameTiles::length(const Lanes& x, const Lanes& y, Lanes& out) const {
  interpolate_lanes(&Level::length, 0.0F, x, y, out);
}

float FlameTiles::ground_at(float x, float y) const {
  const Level* at = level(x, y);
  if (at == nullptr) {
    return none;
  }
  const float column = (x - at->x) * at->inverse, row = (y - at->y) * at->inverse;
  const auto i = static_cast<std::int32_t>(row), j = static_cast<std::int32_t>(column);
  return interpolate_cell(at->ground, at->columns, i, j, row - static_cast<float>(i),
                          column - static_cast<float>(j));
}

FlameTiles::Roots FlameTiles::rooted(float x, float y) const {
  const Level* at = level(x, y);
  if (at == nullptr) {
    return {0.0F, outside};
  }
  const float scale = at->inverse / static_cast<float>(side);
  const float row = (y - at->y) * scale, column = (x - at->x) * scale;
  const auto i = static_cast<std::int64_t>(row), j = static_cast<std::int64_t>(column);
  const float up = row - static_cast<float>(i), right = column - static_cast<float>(j);
  const float edge = std::min(std::min(up, 1.0F - up), std::min(right, 1.0F - right));
  return {at->rooted[static_cast<std::size_t>(i * at->tile_columns + j)],
          (edge + overshoot) / scale};
}

float FlameTiles::spindle_distance(float x, float y, float z, float across) const {
  constexpr float far = std::numeric_limits<float>::max();
  if (spindles_.empty()) {
    return far;
  }
  const float i = (x - spindle_corner_[0]) / spindle_cell,
              j = (y - spindle_corner_[1]) / spindle_cell;
  const float wide = static_cast<float>(spindle_cells_[0]),
              deep = static_cast<float>(spindle_cells_[1]);
  float edge = std::max(std::max(-i, i - wide), std::max(-j, j - deep));
  float over = far;
  if (edge < 0.0F) {
    const float right = i - std::floor(i), up = j - std::floor(j);
    edge = std::min(std::min(up, 1.0F - up), std::min(right, 1.0F - right));
    for (const std::uint32_t number : spindles_at(x, y)) {
      const Spindle& crown = spindles_[number];
      over = std::min(over, z - crown.z - crown_top * crown.top);
    }
  }
  if (over <= 0.0F) {
    return 0.0F;
  }
  return std::min(over, (edge + overshoot) * spindle_cell / std::max(across, 0.01F));
}

bool FlameTiles::find(float x, float y, Tile& tile) const {
  const Level* at = level(x, y);
  if (at == nullptr) {
    return false;
  }
  const float span = at->spacing * static_cast<float>(side);
  const auto i = static_cast<std::int64_t>((y - at->y) / span);
  const auto j = static_cast<std::int64_t>((x - at->x) / span);
  const auto number = static_cast<std::size_t>(i * at->tile_columns + j);
  const float left = at->x + static_cast<float>(j) * span,
              low = at->y + static_cast<float>(i) * span;
  const float last_x = at->x + static_cast<float>(at->columns - 1) * at->spacing;
  const float last_y = at->y + static_cast<float>(at->rows - 1) * at->spacing;
  tile = {at->top[number],
          at->longest[number],
          {left, std::min(left + span, last_x), low, std::min(low + span, last_y)}};
  return true;
}

/// Calls a function with each tile of all levels in a rectangle.
template <class Function>
void FlameTiles::visit(float x0, float x1, float y0, float y1, const Function& function) {
  for (Level& each : levels_) {
    const float scale = each.inverse / static_cast<float>(side);
    const auto tile = [scale](float at, float from, std::int64_t count) {
      return std::clamp(static_cast<std::int64_t>(std::floor((at - from) * scale)),
                        std::int64_t{-1}, count);
    };
    const auto j0 = tile(x0, each.x, each.tile_columns), j1 = tile(x1, each.x, each.tile_columns);
    const auto i0 = tile(y0, each.y, each.tile_rows), i1 = tile(y1, each.y, each.tile_rows);
    for (auto i = std::max(i0, std::int64_t{0}); i <= std::min(i1, each.tile_rows - 1); ++i) {
      for (auto j = std::max(j0, std::int64_t{0}); j <= std::min(j1, each.tile_columns - 1); ++j) {
        function(each, static_cast<std::size_t>(i * each.tile_columns + j));
      }
    }
  }
}

/// Raises the bounds of all tiles of all levels in a rectangle.
void FlameTiles::raise(float x0, float x1, float y0, float y1, float top, float length) {
  any_ = true;
  bounds_ = {std::min(bounds_[0], x0), std::max(bounds_[1], x1), std::min(bounds_[2], y0),
             std::max(bounds_[3], y1)};
  heights_[1] = std::max(heights_[1], top);
  visit(x0, x1, y0, y1, [top, length](Level& level, std::size_t number) {
    level.top[number] = std::max(level.top[number], top);
    level.longest[number] = std::max(level.longest[number], length);
  });
}

void FlameTiles::bound_tiles(const std::array<double, 2>& wind, double launch,
                             double acceleration) {
  const auto drift = [&](double height, std::size_t axis) {
    return static_cast<float>(wind[axis] * flight_time(height, launch, acceleration));
  };
  for (std::size_t n = 0; n < levels_.size(); ++n) {
    for (std::int64_t ti = 0; ti < levels_[n].tile_rows; ++ti) {
      for (std::int64_t tj = 0; tj < levels_[n].tile_columns; ++tj) {
        const Level& each = levels_[n];
        const std::int64_t i0 = ti * side, j0 = tj * side;
        const std::int64_t i1 = std::min(i0 + side, each.rows - 1),
                           j1 = std::min(j0 + side, each.columns - 1);
        float longest = 0.0F, ground = none;
        for (std::int64_t i = i0; i <= i1; ++i) {
          for (std::int64_t j = j0; j <= j1; ++j) {
            const auto at = static_cast<std::size_t>(i * each.columns + j);
            longest = std::max(longest, each.length[at]);
            ground = std::max(ground, each.ground[at]);
          }
        }
        if (longest <= 0.0F) {
          continue;
        }
        heights_[0] = std::min(heights_[0], ground - 50.0F);
        const float high = soot_top * longest, sway = std::min(swing * longest, most_swing);
        const float dx = drift(static_cast<double>(high), 0),
                    dy = drift(static_cast<double>(high), 1);
        const float x = each.x + static_cast<float>(j0) * each.spacing,
                    y = each.y + static_cast<float>(i0) * each.spacing;
        const float wide = static_cast<float>(j1 - j0) * each.spacing,
                    deep = static_cast<float>(i1 - i0) * each.spacing;
        visit(x - sway, x + wide + sway, y - sway, y + deep + sway,
              [longest](Level& level, std::size_t number) {
                level.rooted[number] = std::max(level.rooted[number], longest);
              });
        raise(x + std::min(dx, 0.0F) - sway, x + wide + std::max(dx, 0.0F) + sway,
              y + std::min(dy, 0.0F) - sway, y + deep + std::max(dy, 0.0F) + sway,
              ground + high + sway, longest);
      }
    }
  }
}

void FlameTiles::list_spindles(const std::array<double, 2>& wind, double launch,
                               double acceleration) {
  if (spindles_.empty()) {
    return;
  }
  std::array<float, 4> box{bounds_};
  std::vector<std::array<float, 4>> boxes;
  for (const Spindle& each : spindles_) {
    const float wide = crown_wide * each.radius + crown_sway;
    const double free = static_cast<double>((crown_top - upright) * each.top);
    const double flight = static_cast<double>(lean) * flight_time(free, launch, acceleration);
    const auto dx = static_cast<float>(wind[0] * flight), dy = static_cast<float>(wind[1] * flight);
    boxes.push_back({each.x + std::min(dx, 0.0F) - wide, each.x + std::max(dx, 0.0F) + wide,
                     each.y + std::min(dy, 0.0F) - wide, each.y + std::max(dy, 0.0F) + wide});
    const auto& b = boxes.back();
    raise(b[0], b[1], b[2], b[3], each.z + crown_top * each.top, each.top);
    heights_[0] = std::min(heights_[0], each.z);
    box = bounds_;
  }
  spindle_corner_ = {box[0], box[2]};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    spindle_cells_[axis] =
        static_cast<std::int64_t>((box[2 * axis + 1] - box[2 * axis]) / spindle_cell) + 1;
  }
  const auto cells = static_cast<std::size_t>(spindle_cells_[0] * spindle_cells_[1]);
  const auto visit = [&](const auto& use) {
    for (std::uint32_t n = 0; n < boxes.size(); ++n) {
      const auto cell = [&](float at, std::size_t axis) {
        return static_cast<std::int64_t>((at - spindle_corner_[axis]) / spindle_cell);
      };
      for (auto j = cell(boxes[n][2], 1); j <= cell(boxes[n][3], 1); ++j) {
        for (auto i = cell(boxes[n][0], 0); i <= cell(boxes[n][1], 0); ++i) {
          use(static_cast<std::size_t>(j * spindle_cells_[0] + i), n);
        }
      }
    }
  };
  starts_.assign(cells + 1, 0);
  visit([&](std::size_t cell, std::uint32_t) { ++starts_[cell + 1]; });
  for (std::size_t cell = 0; cell < cells; ++cell) {
    starts_[cell + 1] += starts_[cell];
  }
  numbers_.resize(starts_.back());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  visit([&](std::size_t cell, std::uint32_t n) { numbers_[next[cell]++] = n; });
}

std::span<const std::uint32_t> FlameTiles::spindles_at(float x, float y) const {
  if (spindles_.empty()) {
    return {};
  }
  const float i = (x - spindle_corner_[0]) / spindle_cell,
              j = (y - spindle_corner_[1]) / spindle_cell;
  if (!(i >= 0.0F && j >= 0.0F && i < static_cast<float>(spindle_cells_[0]) &&
        j < static_cast<float>(spindle_cells_[1]))) {
    return {};
  }
  const auto cell = static_cast<std::size_t>(static_cast<std::int64_t>(j) * spindle_cells_[0] +
                                             static_cast<std::int64_t>(i));
  return std::span(numbers_).subspan(starts_[cell], starts_[cell + 1] - starts_[cell]);
}

} // namespace firetwin::flames
