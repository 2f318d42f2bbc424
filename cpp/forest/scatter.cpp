#include "forest/scatter.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

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

void add_place(Plants& plants, std::size_t cell, const std::array<double, 3>& place) {
  plants.cell.push_back(static_cast<std::int64_t>(cell));
  plants.position.insert(plants.position.end(), place.begin(), place.end());
}

void add_tree(Plants& plants, const Site& site, std::size_t y, std::size_t x, double fuel,
              double max_fuel) {
  const auto stand = place(site, y, x);
  if (!stand) {
    return;
  }
  const std::size_t cell = y * site.longitude.size() + x;
  const auto random = draw(site, cell, Use::tree);
  const SizeClass kind = size_class(fuel);
  const Class& c = classes[kind];
  const double height = lerp(6.0, 18.0, std::clamp(fuel / max_fuel, 0.0, 1.0)) *
                        lerp(c.multiplier_low, c.multiplier_high, random[0]) *
                        lerp(0.8, 1.2, random[1]);
  add_place(plants, cell, *stand);
  plants.size_class.push_back(kind);
  plants.model.push_back(static_cast<std::uint8_t>(random[2] * c.models));
  plants.scale.push_back(static_cast<float>(height));
  plants.rotation.push_back(static_cast<float>(2.0 * std::numbers::pi * random[3]));
}

void add_clump(Plants& plants, const Site& site, std::size_t y, std::size_t x) {
  auto stand = place(site, y, x);
  if (!stand) {
    return;
  }
  (*stand)[2] -= grass_depth;
  const std::size_t cell = y * site.longitude.size() + x;
  add_place(plants, cell, *stand);
  plants.scale.push_back(1.0F);
  plants.rotation.push_back(
      static_cast<float>(2.0 * std::numbers::pi * draw(site, cell, Use::grass)[0]));
}

template <class T> void append(std::vector<T>& all, const std::vector<T>& part) {
  all.insert(all.end(), part.begin(), part.end());
}

/// Fills one Plants per row in parallel and joins them in order.
template <class Row> Plants scatter(const Site& site, Row row) {
  if (!(site.jitter >= 0.0 && site.jitter <= 1.0)) {
    throw std::invalid_argument("jitter must be between 0 and 1");
  }
  std::vector<Plants> rows(site.latitude.size());
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t y) { row(rows[y], y); });
  Plants all;
  for (const Plants& part : rows) {
    append(all.cell, part.cell);
    append(all.position, part.position);
    append(all.size_class, part.size_class);
    append(all.model, part.model);
    append(all.scale, part.scale);
    append(all.rotation, part.rotation);
  }
  return all;
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
  const std::size_t columns = site.longitude.size();
  return scatter(site, [&](Plants& plants, std::size_t y) {
    for (std::size_t x = 0; x < columns; ++x) {
      const double fuel = double{canopy_fuel[y * columns + x]};
      if (fuel > least_canopy_fuel && std::isfinite(fuel)) {
        add_tree(plants, site, y, x, fuel, max_fuel);
      }
    }
  });
}

Plants grass(std::span<const float> surface_fuel, const Site& site) {
  const std::size_t columns = site.longitude.size();
  return scatter(site, [&](Plants& plants, std::size_t y) {
    for (std::size_t x = 0; x < columns; ++x) {
      const float fuel = surface_fuel[y * columns + x];
      if (fuel > 0.0F && std::isfinite(fuel)) {
        add_clump(plants, site, y, x);
      }
    }
  });
}

} // namespace firetwin::forest
