#include "forest/scatter.hpp"

#include "forest/ground.hpp"

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
std::vector<std::size_t> offsets(const Site& site, const Ground& ground, Grows grows) {
  const std::size_t columns = site.longitude.size();
  std::vector<std::size_t> result(site.latitude.size() + 1, 0);
  tbb::parallel_for(std::size_t{0}, site.latitude.size(), [&](std::size_t y) {
    std::array<double, 3> unused{};
    std::size_t count = 0;
    for (std::size_t x = 0; x < columns; ++x) {
      const bool fuel = grows(y * columns + x);
      count += fuel && (ground.whole() || ground.place(y, x, unused.data()));
    }
    result[y + 1] = count;
  });
  std::partial_sum(result.begin(), result.end(), result.begin());
  return result;
}

/// Places a plant in each cell that `grows`, and has `write(plants, i, cell)` fill in the rest.
template <class Grows, class Write>
Plants scatter(const Site& site, bool trees, Grows grows, Write write) {
  if (!(site.jitter >= 0.0 && site.jitter <= 1.0)) {
    throw std::invalid_argument("jitter must be between 0 and 1");
  }
  const Ground ground(site);
  const std::vector<std::size_t> offset = offsets(site, ground, grows);
  const std::size_t n = offset.back();
  Plants plants{Buffer<std::int64_t>(n),
                Buffer<double>(3 * n),
                Buffer<std::uint8_t>(trees ? n : 0),
                Buffer<std::uint8_t>(trees ? n : 0),
                Buffer<float>(n),
                Buffer<float>(n)};
  const std::size_t columns = site.longitude.size();
  tbb::parallel_for(std::size_t{0}, site.latitude.size(), [&](std::size_t y) {
    std::size_t i = offset[y];
    for (std::size_t x = 0; x < columns; ++x) {
      const std::size_t cell = y * columns + x;
      // Past the last plant there is no place to write to.
      if (i < offset[y + 1] && grows(cell) && ground.place(y, x, &plants.position[3 * i])) {
        plants.cell[i] = static_cast<std::int64_t>(cell);
        write(plants, i, cell);
        ++i;
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
  if (!(max_fuel > 0.0) || !std::isfinite(max_fuel)) {
    throw std::invalid_argument("max_fuel must be finite and above 0");
  }
  return scatter(
      site, true,
      [&](std::size_t cell) {
        return double{canopy_fuel[cell]} > least_canopy_fuel && std::isfinite(canopy_fuel[cell]);
      },
      [&](Plants& plants, std::size_t i, std::size_t cell) {
        write_tree(plants, i, site, double{canopy_fuel[cell]}, max_fuel);
      });
}

Plants grass(std::span<const float> surface_fuel, const Site& site) {
  return scatter(
      site, false,
      [&](std::size_t cell) {
        return surface_fuel[cell] > 0.0F && std::isfinite(surface_fuel[cell]);
      },
      [&](Plants& plants, std::size_t i, std::size_t) { write_clump(plants, i, site); });
}

} // namespace firetwin::forest
