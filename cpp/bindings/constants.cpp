#include "base/constants.hpp"

#include "bindings.hpp"

namespace firetwin::bindings {

void init_constants(Module module) {
  module.attr("GRAVITY") = constants::gravity;
  module.attr("STEFAN_BOLTZMANN") = constants::stefan_boltzmann;
  module.attr("SEMI_MAJOR_AXIS") = constants::semi_major_axis;
  module.attr("ECCENTRICITY_SQUARED") = constants::eccentricity_squared;
  module.attr("SPECIFIC_HEAT") = constants::specific_heat;
  module.attr("AIR_TEMPERATURE") = constants::air_temperature;
  module.attr("AIR_DENSITY") = constants::air_density;
  module.attr("BUOYANCY_FLUX") = constants::buoyancy_flux;
  module.attr("HEAT_OF_COMBUSTION") = constants::heat_of_combustion;
}

} // namespace firetwin::bindings
