#include "forest/scatter.hpp"

#include "base/check.hpp"
#include "base/interpolation.hpp"
#include "forest/allometry.hpp"
#include "forest/placement.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace firetwin::forest {
namespace {

using Range = tbb::blocked_range<std::size_t>;
constexpr std::size_t rows_per_task = 16;
constexpr std::size_t max_gap = 16; // longest gap of empty cells within a run

constexpr double grass_depth = 0.70; // m

struct Class {
  double min_fuel; ///< kg/m2
  double multiplier_low;
  double multiplier_high;
  int models;
};

/// Size classes, indexed by SizeClass.
constexpr std::array<Class, 3> classes = {
    {{min_canopy_fuel, 0.7, 1.0, 4}, {0.8, 0.9, 1.2, 4}, {1.6, 1.1, 1.4, 2}}};

SizeClass size_class(double fuel) {
  return fuel >= classes[large_tree].min_fuel    ? large_tree
         : fuel >= classes[medium_tree].min_fuel ? medium_tree
                                                 : small_tree;
}

void write_tree(Plants& plants, std::size_t i, const PlantingSite& site, double fuel,
                double max_fuel) {
  const auto random = draw(site, static_cast<std::size_t>(plants.cell[i]), RandomStream::tree);
  const SizeClass kind = size_class(fuel);
  const Class& c = classes[kind];
  const double height = lerp(6.0, 18.0, std::clamp(fuel / max_fuel, 0.0, 1.0)) *
                        lerp(c.multiplier_low, c.multiplier_high, random[0]) *
                        lerp(0.8, 1.2, random[1]);
  plants.size_class[i] = kind;
  plants.model[i] = static_cast<std::uint8_t>(random[2] * c.models);
  plants.scale[i] = static_cast<float>(height);
  plants.rotation[i] = static_cast<float>(2.0 * std::numbers::pi * random[3]);
}

void write_clump(Plants& plants, std::size_t i, const PlantingSite& site) {
  const auto random = draw(site, static_cast<std::size_t>(plants.cell[i]), RandomStream::grass);
  plants.position[3 * i + 2] -= grass_depth;
  plants.scale[i] = 1.0F;
  plants.rotation[i] = static_cast<float>(2.0 * std::numbers::pi * random[0]);
}

/// Lists the columns of a row with a plant and returns their number.
///
/// Branch-free, because branches would be unpredictable; writes one element past the last.
template <class Grows>
std::size_t list_all(std::size_t y, std::size_t columns, Grows grows, Buffer<std::uint32_t>& out) {
  std::size_t n = 0;
  for (std::size_t x = 0; x < columns; ++x) {
    out[n] = static_cast<std::uint32_t>(x);
    n += grows(y * columns + x);
  }
  return n;
}

/// The same for the cells of a mask; skips its empty words, because masks are often sparse.
template <class Grows>
std::size_t list_masked(std::span<const bool> mask, std::size_t y, std::size_t columns, Grows grows,
                        Buffer<std::uint32_t>& out) {
  const bool* row = &mask[y * columns];
  std::size_t n = 0;
  std::uint64_t word = 0;
  for (std::size_t x = 0; x < columns;) {
    if (x + sizeof word <= columns) {
      std::memcpy(&word, row + x, sizeof word);
      if (word == 0) {
        x += sizeof word;
        continue;
      }
    }
    if (row[x] && grows(y * columns + x)) {
      out[n++] = static_cast<std::uint32_t>(x);
    }
    ++x;
  }
  return n;
}

Plants make_plants(std::size_t n, bool trees) {
  const std::size_t classed = trees ? n : 0;
  return {Buffer<std::int64_t>(n),       Buffer<double>(3 * n), Buffer<std::uint8_t>(classed),
          Buffer<std::uint8_t>(classed), Buffer<float>(n),      Buffer<float>(n)};
}

/// Places the plants of a row in runs of columns: sparse rows stay cheap, and dense runs vectorize.
void place(const Placement& placement, std::size_t y, std::span<const std::uint32_t> column,
           Placement::Row& row) {
  for (std::size_t k = 0; k < column.size();) {
    const std::size_t first = column[k];
    std::size_t last = first + 1;
    for (++k; k < column.size() && column[k] < last + max_gap; ++k) {
      last = std::size_t{column[k]} + 1;
    }
    placement.place(y, first, last, row);
  }
}

/// Places a plant in each cell with `fuel` and calls `write(plants, i)` for its other properties.
template <class Fuel, class Write>
Plants scatter(const PlantingSite& site, bool trees, Fuel fuel, Write write) {
  if (!(site.jitter >= 0.0 && site.jitter <= 1.0)) {
    throw std::invalid_argument("jitter must be between 0 and 1");
  }
  const Placement placement(site);
  const std::size_t rows = site.latitude.size(), columns = site.longitude.size();
  const auto grows = [&](std::size_t cell) {
    return static_cast<bool>(fuel(cell) & placement.has_elevation(cell));
  };
  const auto list = [&](std::size_t y, Buffer<std::uint32_t>& out) {
    return site.mask.empty() ? list_all(y, columns, grows, out)
                             : list_masked(site.mask, y, columns, grows, out);
  };
  std::vector<std::size_t> offset(rows + 1, 0); // first plant of each row, and their total
  tbb::parallel_for(Range(0, rows, rows_per_task), [&](const Range& range) {
    Buffer<std::uint32_t> column(columns + 1);
    for (std::size_t y = range.begin(); y < range.end(); ++y) {
      offset[y + 1] = list(y, column);
    }
  });
  std::partial_sum(offset.begin(), offset.end(), offset.begin());
  Plants plants = make_plants(offset.back(), trees);
  tbb::parallel_for(Range(0, rows, rows_per_task), [&](const Range& range) {
    Placement::Row row(columns);
    Buffer<std::uint32_t> column(columns + 1);
    for (std::size_t y = range.begin(); y < range.end(); ++y) {
      if (offset[y] == offset[y + 1]) {
        continue;
      }
      const std::size_t n = list(y, column);
      for (std::size_t k = 0; k < n; ++k) {
        const auto random = draw(site, y * columns + column[k], RandomStream::place);
        row.north[column[k]] = random[0];
        row.east[column[k]] = random[1];
      }
      place(placement, y, {column.data(), n}, row);
      for (std::size_t k = 0; k < n; ++k) {
        const std::size_t i = offset[y] + k, x = column[k];
        plants.cell[i] = static_cast<std::int64_t>(y * columns + x);
        plants.position[3 * i] = row.x[x];
        plants.position[3 * i + 1] = row.y[x];
        plants.position[3 * i + 2] = row.z[x];
        write(plants, i);
      }
    }
  });
  return plants;
}

} // namespace

int models(SizeClass kind) {
  return classes[kind].models;
}

float largest_fuel(std::span<const float> fuel) {
  constexpr std::size_t lanes = 16; // widest SIMD register
  std::array<float, lanes> largest{};
  const auto add = [&](std::size_t lane, float f) {
    largest[lane] =
        (f > largest[lane]) & (f <= std::numeric_limits<float>::max()) ? f : largest[lane];
  };
  std::size_t i = 0;
  for (; i + lanes <= fuel.size(); i += lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      add(lane, fuel[i + lane]);
    }
  }
  for (; i < fuel.size(); ++i) {
    add(0, fuel[i]);
  }
  return *std::max_element(largest.begin(), largest.end());
}

Plants trees(std::span<const float> canopy_fuel, const PlantingSite& site, double max_fuel) {
  check_above_zero(max_fuel, "max_fuel");
  const auto fuel = [canopy_fuel](std::size_t cell) {
    return static_cast<bool>((double{canopy_fuel[cell]} > min_canopy_fuel) &
                             std::isfinite(canopy_fuel[cell]));
  };
  return scatter(site, true, fuel, [&](Plants& plants, std::size_t i) {
    const float here = canopy_fuel[static_cast<std::size_t>(plants.cell[i])];
    write_tree(plants, i, site, double{here}, max_fuel);
  });
}

Plants grass(std::span<const float> surface_fuel, const PlantingSite& site) {
  const auto fuel = [surface_fuel](std::size_t cell) {
    return static_cast<bool>((surface_fuel[cell] > 0.0F) & std::isfinite(surface_fuel[cell]));
  };
  return scatter(site, false, fuel,
                 [&](Plants& plants, std::size_t i) { write_clump(plants, i, site); });
}

} // namespace firetwin::forest
