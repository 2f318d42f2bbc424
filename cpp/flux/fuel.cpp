#include "flux/fuel.hpp"

#include "geo/axis.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace firetwin::flux {

std::vector<float> fuel_load(const run::Run& run) {
  std::vector<float> result(run.fuel_latitude().size() * run.fuel_longitude().size(), 0.0F);
  for (const run::Plane* plane : {&run.surface_fuel(), &run.canopy_fuel()}) {
    auto sum = result.begin();
    plane->each([&](std::span<const float> values) {
      for (const float value : values) {
        *sum++ += std::isnan(value) ? 0.0F : value;
      }
    });
  }
  return result;
}

std::vector<double> fuel_of_cells(const run::Run& run) {
  const std::vector<float> load = fuel_load(run);
  const std::vector<std::size_t> row = geo::nearest(run.latitude(), run.fuel_latitude());
  const std::vector<std::size_t> column = geo::nearest(run.longitude(), run.fuel_longitude());
  std::vector<double> sum(run.cells(), 0.0), count(run.cells(), 0.0);
  for (std::size_t y = 0; y < row.size(); ++y) {
    for (std::size_t x = 0; x < column.size(); ++x) {
      const std::size_t cell = row[y] * run.longitude().size() + column[x];
      sum[cell] += double{load[y * column.size() + x]};
      count[cell] += 1.0;
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (run.scan().cells[i].first != run::Scan::never && !(sum[i] > 0.0)) {
      return {};
    }
    sum[i] /= std::max(count[i], 1.0);
  }
  return sum;
}

} // namespace firetwin::flux
