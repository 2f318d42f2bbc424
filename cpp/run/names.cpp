#include "run/names.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace firetwin::run {
namespace {

using Spellings = std::array<std::string_view, 5>;

constexpr Spellings degrees_north = {"degrees_north", "degrees", "degree", "deg", "deg N"};
constexpr Spellings degrees_east = {"degrees_east", "degrees", "degree", "deg", "deg E"};
constexpr Spellings metres = {"m", "metre", "metres", "meter", "meters"};
constexpr Spellings load = {"kg/m2", "kg/m^2", "kg/m²", "kg m-2", "kg m^-2"};
constexpr Spellings flux = {"W/m2", "W/m^2", "W/m²", "W m-2", "W m^-2"};
constexpr Spellings kelvin = {"K", "kelvin", "Kelvin", "degK", "deg K"};
constexpr Spellings speed = {"m/s", "m s-1", "m s^-1", "ms-1", "metres per second"};
constexpr Spellings seconds = {"s", "second", "seconds", "sec", "secs"};
constexpr Spellings density = {"kg/m3", "kg/m^3", "kg/m³", "kg m-3", "kg m^-3"};

constexpr std::array<FieldUnit, 19> fields = {{{"latitude", degrees_north},
                                               {"longitude", degrees_east},
                                               {"elevation", metres},
                                               {"fuel_latitude", degrees_north},
                                               {"fuel_longitude", degrees_east},
                                               {"fuel_elevation", metres},
                                               {"fuel_arrival_time", seconds},
                                               {"surface_fuel", load},
                                               {"canopy_fuel", load},
                                               {"heat_flux", flux},
                                               {"temperature", kelvin},
                                               {"wind_east", speed},
                                               {"wind_north", speed},
                                               {"temperature_3d", kelvin},
                                               {"smoke_3d", density},
                                               {"height_3d", metres},
                                               {"wind_east_3d", speed},
                                               {"wind_north_3d", speed},
                                               {"wind_up_3d", speed}}};

std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) {
    row[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

} // namespace

std::span<const FieldUnit> field_units() {
  return fields;
}

const FieldUnit* find_field(std::string_view name) {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [name](const FieldUnit& f) { return f.field == name; });
  return found == fields.end() ? nullptr : &*found;
}

std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known) {
  std::string_view best;
  std::size_t least = 4;
  for (const std::string_view candidate : known) {
    if (const std::size_t d = distance(name, candidate); d < least) {
      least = d;
      best = candidate;
    }
  }
  return best;
}

} // namespace firetwin::run
