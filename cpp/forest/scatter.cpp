#include "forest/scatter.hpp"

#include "base/check.hpp"
#include "forest/placement.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace firetwin::forest {
namespace {

using Range = tbb::blocked_range<std::size_t>;
constexpr std::size_t rows_per_task = 16;

constexpr double least_canopy_fuel = 0.01; // kg/m2
constexpr double grass_depth = 0.70;       // m

struct Class {
  double least_fuel; ///< kg/m2
  double multiplier_low;
  double multiplier_high;
  int models;
};

/// Indexed by SizeClass.
constexpr std::array<Class, 3> classes = {
    {{least_canopy_fuel, 0.7, 1.0, 4}, {0.8, 0.9, 1.2, 4}, {1.6, 1.1, 1.4, 2}}};

double lerp(double low, double high, double t) {
  return low + t * (high - low);
}

SizeClass size_class(double fuel) {
  return fuel >= classes[large_tree].least_fuel    ? large_tree
         : fuel >= classes[medium_tree].least_fuel ? medium_tree
                                                   : small_tree;
}

void write_tree(Plants& plants, std::size_t i, const Site& site, double fuel, double max_fuel) {
  const auto random = draw(site, static_cast<std::size_t>(plants.cell[i]), Use::tree);
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

void write_clump(Plants& plants, std::size_t i, const Site& site) {
  const auto random = draw(site, static_cast<std::size_t>(plants.cell[i]), Use::grass);
  plants.position[3 * i + 2] -= grass_depth;
  plants.scale[i] = 1.0F;
  plants.rotation[i] = static_cast<float>(2.0 * std::numbers::pi * random[0]);
}

/// How many plants stand in the rows before each row, and in all of them.
template <class Grows>
std::vector<std::size_t> offsets(std::size_t rows, std::size_t columns, Grows grows) {
  std::vector<std::size_t> result(rows + 1, 0);
  tbb::parallel_for(Range(0, rows, rows_per_task), [&](const Range& range) {
    for (std::size_t y = range.begin(); y < range.end(); ++y) {
      std::size_t count = 0;
      for (std::size_t x = 0; x < columns; ++x) {
        count += grows(y * columns + x);
      }
      result[y + 1] = count;
    }
  });
  std::partial_sum(result.begin(), result.end(), result.begin());
  return result;
}

/// The columns of a row whose cells grow something. Without branches, which could not be predicted;
/// so the place after the last is written to as well.
template <class Grows>
void list(std::size_t y, std::size_t columns, Grows grows, Buffer<std::uint32_t>& out) {
  std::size_t n = 0;
  for (std::size_t x = 0; x < columns; ++x) {
    out[n] = static_cast<std::uint32_t>(x);
    n += grows(y * columns + x);
  }
}

Plants make_plants(std::size_t n, bool trees) {
  const std::size_t classed = trees ? n : 0;
  return {Buffer<std::int64_t>(n),       Buffer<double>(3 * n), Buffer<std::uint8_t>(classed),
          Buffer<std::uint8_t>(classed), Buffer<float>(n),      Buffer<float>(n)};
}

/// Places a plant in each cell that has `fuel`, and has `write(plants, i)` fill in the rest.
template <class Fuel, class Write>
Plants scatter(const Site& site, bool trees, Fuel fuel, Write write) {
  if (!(site.jitter >= 0.0 && site.jitter <= 1.0)) {
    throw std::invalid_argument("jitter must be between 0 and 1");
  }
  const Placement placement(site);
  const auto grows = [&](std::size_t cell) {
    return static_cast<bool>(fuel(cell) & placement.holds(cell));
  };
  const std::size_t columns = site.longitude.size();
  const std::vector<std::size_t> offset = offsets(site.latitude.size(), columns, grows);
  Plants plants = make_plants(offset.back(), trees);
  tbb::parallel_for(Range(0, site.latitude.size(), rows_per_task), [&](const Range& rows) {
    Placement::Row row(columns);
    Buffer<std::uint32_t> column(columns + 1);
    for (std::size_t y = rows.begin(); y < rows.end(); ++y) {
      const std::size_t n = offset[y + 1] - offset[y];
      list(y, columns, grows, column);
      for (std::size_t k = 0; k < n; ++k) {
        const auto random = draw(site, y * columns + column[k], Use::place);
        row.north[column[k]] = random[0];
        row.east[column[k]] = random[1];
      }
      placement.place(y, row);
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

float largest_fuel(std::span<const float> fuel) {
  float largest = 0.0F;
  for (const float f : fuel) {
    largest = std::isfinite(f) ? std::max(largest, f) : largest;
  }
  return largest;
}

Plants trees(std::span<const float> canopy_fuel, const Site& site, double max_fuel) {
  check_above_zero(max_fuel, "max_fuel");
  const auto fuel = [canopy_fuel](std::size_t cell) {
    return static_cast<bool>((double{canopy_fuel[cell]} > least_canopy_fuel) &
                             std::isfinite(canopy_fuel[cell]));
  };
  return scatter(site, true, fuel, [&](Plants& plants, std::size_t i) {
    const float here = canopy_fuel[static_cast<std::size_t>(plants.cell[i])];
    write_tree(plants, i, site, double{here}, max_fuel);
  });
}

Plants grass(std::span<const float> surface_fuel, const Site& site) {
  const auto fuel = [surface_fuel](std::size_t cell) {
    return static_cast<bool>((surface_fuel[cell] > 0.0F) & std::isfinite(surface_fuel[cell]));
  };
  return scatter(site, false, fuel,
                 [&](Plants& plants, std::size_t i) { write_clump(plants, i, site); });
}

} // namespace firetwin::forest
