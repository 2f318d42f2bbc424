#pragma once

#include "run/run.hpp"

#include <vector>

namespace firetwin::flux {

/// Front passage of the cell centres of the model grid, from the heat flux (see arrival.hpp).
struct FrontPassage {
  /// [ny nx] s; may be after the end of the run. Unburned cells next to burned ones have an
  /// extrapolated time, other unburned cells NaN.
  std::vector<double> time;
  /// [ny nx] burned fraction of each cell at the end of the run, 0..1.
  std::vector<float> burned_fraction;
};

FrontPassage front_passage_from_flux(const run::Run& run);

} // namespace firetwin::flux
