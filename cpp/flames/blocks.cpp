#include "flames/blocks.hpp"

#include "base/clones.hpp"
#include "base/smoothstep.hpp"
#include "flames/soot.hpp"
#include "flames/wrinkles.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace firetwin::flames {
namespace {

constexpr float seen_light = 0.76F; // of a coarse cell: its hot gas is behind cooler gas (measured)
constexpr float full = 255.0F;
constexpr float most_cells = 1.0e6F; // height that an index can hold; nothing burns there
constexpr std::int64_t cube = 8; // cells along a side, which are skipped at once if nothing burns
constexpr float finest_level = 0.75F; // of a pixel: cells up to this size are not coarsened
constexpr std::array<float, 2> level_blend{0.4F, 0.6F};
constexpr std::array<float, 2> wrinkled{0.9F,
                                        0.3F}; // of a cell: pixels that show no eddies, and all
constexpr float eddy_speed = 1.2F; // of eddies below a cell, sqrt(g L): mean rise of hot gas
constexpr float calm_foot = 0.08F; // L, height under which eddies are weaker
constexpr float thickness = 10.0F; // extinction of soot times L at which levels are filtered

/// Wraps a number of cells, at most a few periods away.
std::int32_t wrapped(std::int32_t number, std::int32_t count) {
  number %= count;
  return number < 0 ? number + count : number;
}

__attribute__((always_inline)) inline void floor_lanes(const Lanes& value, LaneIndex& whole,
                                                       Lanes& part) {
  whole = __builtin_convertvector(value, LaneIndex);
  const Lanes back = __builtin_convertvector(whole, Lanes);
  whole += back > value; // true is -1
  part = value - __builtin_convertvector(whole, Lanes);
}

__attribute__((always_inline)) inline void mix(const Lanes& a, const Lanes& b, const Lanes& part,
                                               Lanes& out) {
  out = a + (b - a) * part;
}

/// Cells of eight points across, along and up, and the points' places in them.
struct CellLanes {
  LaneIndex i, j, k;
  Lanes a, b, c;
};

__attribute__((always_inline)) inline void locate(const Lanes& x, const Lanes& y, const Lanes& up,
                                                  CellLanes& out) {
  Lanes z = up < 0.0F ? Lanes{} : up;
  z = z > most_cells ? Lanes{} + most_cells : z;
  floor_lanes(x, out.i, out.a);
  floor_lanes(y, out.j, out.b);
  floor_lanes(z, out.k, out.c);
}

/// Extinction, and light that leaves, of each code at a height.
struct CodeTable {
  std::array<float, 256> extinction, light;

  explicit CodeTable(float height) {
    for (std::size_t code = 0; code < 256; ++code) {
      const float mixture = mixture_of(static_cast<float>(code) / full);
      extinction[code] = soot_at(mixture, height);
      light[code] = extinction[code] * luminance_at(heat_at(mixture, height));
    }
  }
};

/// One frame of a block.
struct BlockFrame {
  const std::uint8_t* codes;
  std::int64_t up, along, across;

  bool burns(const std::array<std::int64_t, 3>& first, std::int64_t side) const {
    for (std::int64_t k = first[0]; k < std::min(first[0] + side, up); ++k) {
      for (std::int64_t j = first[1]; j < std::min(first[1] + side, along); ++j) {
        const std::uint8_t* row = codes + (k * along + j) * across;
        if (std::any_of(row + first[2], row + std::min(first[2] + side, across),
                        [](std::uint8_t code) { return code != 0; })) {
          return true;
        }
      }
    }
    return false;
  }

  /// Filters a cube of cells: the extinction that lets the same mean share of light through, and
  /// extinction times the heat of the mean light, in 8 bits each.
  std::uint16_t filter(std::span<const CodeTable> tables, const std::array<std::int64_t, 3>& first,
                       std::int64_t side, float cell) const {
    float through = 0.0F, extinction = 0.0F, light = 0.0F;
    const std::int64_t k1 = std::min(first[0] + side, up), j1 = std::min(first[1] + side, along),
                       i1 = std::min(first[2] + side, across);
    for (std::int64_t k = first[0]; k < k1; ++k) {
      const CodeTable& table = tables[static_cast<std::size_t>(k)];
      for (std::int64_t j = first[1]; j < j1; ++j) {
        const std::uint8_t* row = codes + (k * along + j) * across;
        float column = 0.0F;
        for (std::int64_t i = first[2]; i < i1; ++i) {
          column += table.extinction[row[i]];
          light += table.light[row[i]];
        }
        extinction += column;
        through += column > 0.0F ? std::exp(-thickness * cell * column) : 1.0F;
      }
    }
    if (extinction <= 0.0F) {
      return 0;
    }
    const auto columns = static_cast<float>((k1 - first[0]) * (j1 - first[1]));
    const float deep = thickness * cell * static_cast<float>(i1 - first[2]);
    const float mean = std::min(-std::log(std::max(through / columns, 1.0e-6F)) / deep, 1.0F);
    const float heat = heat_of(seen_light * light / extinction);
    const auto code = [](float value) { return static_cast<std::uint32_t>(value * full + 0.5F); };
    return static_cast<std::uint16_t>(code(mean) | code(mean * heat) << 8U);
  }
};

} // namespace

BlockLevels::BlockLevels(float pixel, float cell) {
  const auto last = static_cast<float>(FlameBlock::levels);
  const float at = std::log2(std::max(pixel * finest_level / cell, 1.0F));
  number = std::min(static_cast<int>(at), FlameBlock::levels);
  part = at < last ? smoothstep(level_blend[0], level_blend[1], at - static_cast<float>(number))
                   : 0.0F;
  detail = 1.0F - smoothstep(wrinkled[1], wrinkled[0], pixel / cell);
}

FlameBlock::FlameBlock(std::span<const std::uint8_t> codes, const Shape& shape,
                       const BlockScale& scale, std::span<const float> rise)
    : codes_(codes.begin(), codes.end()), shape_(shape), scale_(scale) {
  constexpr std::int64_t most = 1 << 20;
  std::int64_t cells = 1;
  for (const std::int64_t side : shape) {
    if (side < 2 || side > most) {
      throw std::invalid_argument("codes need at least two frames and cells along each axis");
    }
    cells *= side;
  }
  if (static_cast<std::int64_t>(codes.size()) != cells ||
      static_cast<std::int64_t>(rise.size()) != shape[1]) {
    throw std::invalid_argument("codes must be (frames, up, along, across), and rise (up)");
  }
  if (!(scale.cell > 0.0F && scale.interval > 0.0F) || scale.fade < 0 ||
      2 * scale.fade >= shape[0]) {
    throw std::invalid_argument(
        "cell and interval must be positive, and fade under half the frames");
  }
  for (const float speed : rise) {
    rise_.push_back(speed * scale.interval / scale.cell);
  }
  if (scale.soft) {
    soften();
  }
  mark_burning();
}

/// Softens codes: linear interpolation shows sheets of one cell as stairs if wind shears them.
void FlameBlock::soften() {
  const auto [frames, up, along, across] = shape_;
  const auto plane = static_cast<std::size_t>(along * across);
  const auto mean = [](std::uint8_t low, std::uint8_t at, std::uint8_t high) {
    return static_cast<std::uint8_t>((low + 2 * at + high + 2) / 4);
  };
  tbb::parallel_for(
      std::int64_t{0}, frames, [&, up = up, along = along, across = across](std::int64_t frame) {
        std::uint8_t* first = codes_.data() + static_cast<std::size_t>(frame * up) * plane;
        for (std::int64_t n = 0; n < up * along; ++n) {
          std::uint8_t* row = first + n * across;
          std::uint8_t before = row[0];
          for (std::int64_t i = 0; i < across; ++i) {
            const std::uint8_t at = row[i];
            row[i] = mean(before, at, row[std::min(i + 1, across - 1)]);
            before = at;
          }
        }
        std::vector<std::uint8_t> below(first, first + plane), at(plane);
        for (std::int64_t k = 0; k < up; ++k) {
          std::uint8_t* level = first + static_cast<std::size_t>(k) * plane;
          const std::uint8_t* above = k + 1 < up ? level + plane : level;
          std::copy(level, level + plane, at.begin());
          for (std::size_t n = 0; n < plane; ++n) {
            level[n] = mean(below[n], at[n], above[n]);
          }
          std::swap(below, at);
        }
      });
}

void FlameBlock::mark_burning() {
  const auto [frames, nz, ny, nx] = shape_;
  cubes_ = {(nz + cube - 1) / cube, (ny + cube - 1) / cube, (nx + cube - 1) / cube};
  const auto [up, along, across] = cubes_;
  const std::int64_t count = up * along * across;
  burning_.assign(static_cast<std::size_t>(frames * count), 0);
  const auto mark = [&](std::int64_t frame, std::int64_t k, std::int64_t j, std::int64_t i) {
    for (std::int64_t n = 0; n < 27; ++n) {
      const std::int64_t above = k + n / 9 - 1, right = i + n % 3 - 1;
      const std::int64_t beside = (j + n / 3 % 3 - 1 + along) % along;
      if (above >= 0 && above < up && right >= 0 && right < across) {
        burning_[static_cast<std::size_t>(frame * count + (above * along + beside) * across +
                                          right)] = 1;
      }
    }
  };
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    for (std::int64_t k = 0; k < up; ++k) {
      for (std::int64_t j = 0; j < along; ++j) {
        for (std::int64_t i = 0; i < across; ++i) {
          const BlockFrame from{codes_.data() + frame * nz * ny * nx, nz, ny, nx};
          if (!from.burns({k * cube, j * cube, i * cube}, cube)) {
            continue;
          }
          mark(frame, k, j, i);
          if (frame > 0) {
            mark(frame - 1, k, j, i);
          }
        }
      }
    }
  }
}

/// Returns whether something may burn at one of eight places, in cells, at a frame or after it.
bool FlameBlock::burns(std::int64_t frame, const Lanes& x, const Lanes& y, const Lanes& z) const {
  constexpr float inverse = 1.0F / static_cast<float>(cube);
  const auto [up, along, across] = cubes_;
  const std::uint8_t* cubes = burning_.data() + frame * up * along * across;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const float right = x[lane] * inverse, above = std::max(z[lane], 0.0F) * inverse;
    if (!(x[lane] >= -1.0F && right < static_cast<float>(across) &&
          above < static_cast<float>(up))) {
      continue;
    }
    const auto i = static_cast<std::int32_t>(right), k = static_cast<std::int32_t>(above);
    auto j = static_cast<std::int32_t>(std::floor(y[lane] * inverse));
    j = wrapped(j, static_cast<std::int32_t>(along));
    if (cubes[(k * along + j) * across + i] != 0) {
      return true;
    }
  }
  return false;
}

double FlameBlock::period() const {
  return static_cast<double>(shape_[0] - scale_.fade) * static_cast<double>(scale_.interval);
}

FlameBlock::Parts FlameBlock::parts_at(float time) const {
  const float at =
      std::clamp(time / scale_.interval, 0.0F, static_cast<float>(shape_[0] - 1) - 1.0e-3F);
  const auto frame = static_cast<std::int64_t>(at);
  const float part = at - static_cast<float>(frame);
  return {{{frame, 1.0F - part, part}, {frame + 1, part, part - 1.0F}}};
}

void FlameBlock::rise_at(const Lanes& up, Lanes& cells) const {
  const auto last = static_cast<float>(rise_.size() - 1);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    cells[lane] = rise_[static_cast<std::size_t>(std::clamp(up[lane], 0.0F, last))];
  }
}

FIRETWIN_CLONES("avx2")
void FlameBlock::codes(const BlockPlaces& places, float time, float detail, Lanes& out) const {
  const float inverse = 1.0F / scale_.cell;
  Lanes x = places.across * inverse - 0.5F, y = places.along * inverse - 0.5F,
        z = places.up * inverse - 0.5F;
  out = Lanes{};
  const Parts parts = parts_at(time);
  if (!burns(parts[0].frame, x, y, z)) {
    return;
  }
  Lanes risen;
  rise_at(z, risen);
  if (detail > 0.0F) {
    const float carried = eddy_speed * time * inverse;
    Lanes strength = places.up * (detail / calm_foot);
    strength = strength > detail ? Lanes{} + detail : strength;
    z -= carried;
    wrinkle(x, y, z, strength);
    z += carried;
  }
  for (const Part& part : parts) {
    add_codes(part, x, y, z - risen * part.risen, out);
  }
  out *= 1.0F / full;
}

__attribute__((always_inline)) inline void FlameBlock::add_codes(const Part& part, const Lanes& x,
                                                                 const Lanes& y, const Lanes& up,
                                                                 Lanes& out) const {
  const auto nz = static_cast<std::int32_t>(shape_[1]), ny = static_cast<std::int32_t>(shape_[2]),
             nx = static_cast<std::int32_t>(shape_[3]);
  CellLanes cells;
  locate(x, y, up, cells);
  auto& [i, j, k, a, b, c] = cells;
  const std::uint8_t* codes = codes_.data() + part.frame * nz * ny * nx;
  using Pairs = Simd<std::int32_t, lane_count>; // two neighbours across the front in a number
  std::array<Pairs, 4> corner{};
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    if (i[lane] < 0 || i[lane] >= nx - 1 || k[lane] >= nz - 1 ||
        (!scale_.periodic && (j[lane] < 0 || j[lane] >= ny - 1))) {
      continue;
    }
    const std::int32_t row = wrapped(j[lane], ny), after = row + 1 == ny ? 0 : row + 1;
    const std::int32_t level = k[lane] * ny;
    const std::array<std::int32_t, 4> rows{level + row, level + after, level + ny + row,
                                           level + ny + after};
    for (std::size_t n = 0; n < 4; ++n) {
      std::uint16_t pair;
      std::memcpy(&pair, codes + rows[n] * nx + i[lane], sizeof pair);
      corner[n][lane] = pair;
    }
  }
  std::array<Lanes, 4> edge;
  for (std::size_t n = 0; n < 4; ++n) {
    const Lanes low = __builtin_convertvector(corner[n] & 0xff, Lanes),
                high = __builtin_convertvector(corner[n] >> 8, Lanes);
    mix(low, high, a, edge[n]);
  }
  Lanes near, far, value;
  mix(edge[0], edge[1], b, near);
  mix(edge[2], edge[3], b, far);
  mix(near, far, c, value);
  out += value * part.weight;
}

FIRETWIN_CLONES("avx2")
void FlameBlock::coarse(int number, const BlockPlaces& places, float time, CoarseFlame& out) const {
  const Level& from = level(number);
  const float inverse = 1.0F / scale_.cell, coarser = 1.0F / static_cast<float>(1 << number);
  out = CoarseFlame{Lanes{}, Lanes{}};
  const Parts parts = parts_at(time);
  if (!burns(parts[0].frame, places.across * inverse, places.along * inverse,
             places.up * inverse)) {
    return;
  }
  Lanes risen;
  rise_at(places.up * inverse - 0.5F, risen);
  const Lanes x = places.across * (inverse * coarser) - 0.5F,
              y = places.along * (inverse * coarser) - 0.5F, z = places.up * inverse;
  for (const Part& part : parts) {
    add_coarse(from, part, x, y, (z - risen * part.risen) * coarser - 0.5F, out);
  }
  out.extinction *= 1.0F / full;
  out.hot *= 1.0F / full;
}

__attribute__((always_inline)) inline void FlameBlock::add_coarse(const Level& level,
                                                                  const Part& part, const Lanes& x,
                                                                  const Lanes& y, const Lanes& up,
                                                                  CoarseFlame& out) const {
  const auto nz = static_cast<std::int32_t>(level.size[0]),
             ny = static_cast<std::int32_t>(level.size[1]),
             nx = static_cast<std::int32_t>(level.size[2]);
  CellLanes cells;
  locate(x, y, up, cells);
  auto& [i, j, k, a, b, c] = cells;
  i += 1; // the margin
  const std::uint16_t* values = level.values.data() + part.frame * nz * ny * nx;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const auto right = static_cast<std::int32_t>(corner & 1U),
               ahead = static_cast<std::int32_t>((corner >> 1U) & 1U),
               above = static_cast<std::int32_t>(corner >> 2U);
    LaneIndex pairs{};
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const std::int32_t column = i[lane] + right, level_row = k[lane] + above;
      std::int32_t row = j[lane] + ahead;
      if (column < 0 || column >= nx || level_row >= nz ||
          (!scale_.periodic && (row < 0 || row >= ny))) {
        continue;
      }
      row = wrapped(row, ny);
      pairs[lane] = values[(level_row * ny + row) * nx + column];
    }
    const Lanes weight = (right != 0 ? a : 1.0F - a) * (ahead != 0 ? b : 1.0F - b) *
                         (above != 0 ? c : 1.0F - c) * part.weight;
    out.extinction += weight * __builtin_convertvector(pairs & 0xff, Lanes);
    out.hot += weight * __builtin_convertvector(pairs >> 8, Lanes);
  }
}

const FlameBlock::Level& FlameBlock::level(int number) const {
  tbb::collaborative_call_once(built_, [this] { build_levels(); });
  return levels_[static_cast<std::size_t>(number - 1)];
}

void FlameBlock::build_levels() const {
  const auto [frames, nz, ny, nx] = shape_;
  std::vector<CodeTable> tables;
  for (std::int64_t k = 0; k < nz; ++k) {
    tables.emplace_back((static_cast<float>(k) + 0.5F) * scale_.cell);
  }
  for (int number = 1; number <= levels; ++number) {
    const std::int64_t side = std::int64_t{1} << number;
    const auto blocks = [side](std::int64_t cells) { return (cells + side - 1) / side; };
    Level& coarser = levels_[static_cast<std::size_t>(number - 1)];
    coarser.size = {blocks(nz) + 1, blocks(ny), blocks(nx) + 2};
    const auto [up, along, across] = coarser.size;
    coarser.values.assign(static_cast<std::size_t>(frames * up * along * across), 0);
    tbb::parallel_for(std::int64_t{0}, frames, [&](std::int64_t frame) {
      const BlockFrame from{codes_.data() + frame * nz * ny * nx, nz, ny, nx};
      std::uint16_t* out = coarser.values.data() + frame * up * along * across;
      for (std::int64_t k = 0; k < up - 1; ++k) {
        for (std::int64_t j = 0; j < along; ++j) {
          for (std::int64_t i = 0; i < across - 2; ++i) {
            out[(k * along + j) * across + i + 1] =
                from.filter(tables, {k * side, j * side, i * side}, side, scale_.cell);
          }
        }
      }
    });
  }
}

} // namespace firetwin::flames
