#include "run/fields.hpp"

#include <algorithm>
#include <array>

namespace firetwin::run {
namespace {

using Spellings = std::array<std::string_view, 5>;

namespace units {

constexpr Spellings degrees_north = {"degrees_north", "degrees", "degree", "deg", "deg N"};
constexpr Spellings degrees_east = {"degrees_east", "degrees", "degree", "deg", "deg E"};
constexpr Spellings metres = {"m", "metre", "metres", "meter", "meters"};
constexpr Spellings load = {"kg/m2", "kg/m^2", "kg/m²", "kg m-2", "kg m^-2"};
constexpr Spellings flux = {"W/m2", "W/m^2", "W/m²", "W m-2", "W m^-2"};
constexpr Spellings kelvin = {"K", "kelvin", "Kelvin", "degK", "deg K"};
constexpr Spellings speed = {"m/s", "m s-1", "m s^-1", "ms-1", "metres per second"};
constexpr Spellings seconds = {"s", "second", "seconds", "sec", "secs"};
constexpr Spellings density = {"kg/m3", "kg/m^3", "kg/m³", "kg m-3", "kg m^-3"};
constexpr Spellings share = {"1", "fraction", "share", "0..1", "dimensionless"};
constexpr Spellings number = {"1", "number", "category", "class", "dimensionless"};

} // namespace units

constexpr std::array<FieldUnit, 23> fields = {{{"latitude", units::degrees_north},
                                               {"longitude", units::degrees_east},
                                               {"elevation", units::metres},
                                               {"fuel_latitude", units::degrees_north},
                                               {"fuel_longitude", units::degrees_east},
                                               {"fuel_elevation", units::metres},
                                               {"fuel_arrival_time", units::seconds},
                                               {"fuel_category", units::number},
                                               {"burned_fraction", units::share},
                                               {"air_latitude", units::degrees_north},
                                               {"air_longitude", units::degrees_east},
                                               {"surface_fuel", units::load},
                                               {"canopy_fuel", units::load},
                                               {"heat_flux", units::flux},
                                               {"temperature", units::kelvin},
                                               {"wind_east", units::speed},
                                               {"wind_north", units::speed},
                                               {"temperature_3d", units::kelvin},
                                               {"smoke_3d", units::density},
                                               {"height_3d", units::metres},
                                               {"wind_east_3d", units::speed},
                                               {"wind_north_3d", units::speed},
                                               {"wind_up_3d", units::speed}}};

} // namespace

std::span<const FieldUnit> field_units() {
  return fields;
}

const FieldUnit* find_field(std::string_view name) {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [name](const FieldUnit& f) { return f.field == name; });
  return found == fields.end() ? nullptr : &*found;
}

} // namespace firetwin::run
