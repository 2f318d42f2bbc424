#include "flow/ambient.hpp"

#include "base/check.hpp"
#include "flow/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace firetwin::flow {
namespace {

std::vector<double> part(const std::vector<std::array<double, 2>>& wind, std::size_t axis) {
  std::vector<double> result;
  for (const auto& w : wind) {
    result.push_back(w[axis]);
  }
  return result;
}

void check_profile(const Profile& p) {
  const std::size_t n = p.height.size();
  if (n == 0 || p.potential_temperature.size() != n || p.wind.size() != n ||
      (!p.water.empty() && p.water.size() != n)) {
    throw std::invalid_argument("the arrays of the profile must have the same length, at least 1");
  }
  check_finite(p.height, "height");
  check_finite(p.potential_temperature, "potential_temperature");
  check_above_zero(p.pressure, "pressure");
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0 && !(p.height[i] > p.height[i - 1])) {
      throw std::invalid_argument("height must be strictly increasing");
    }
    if (!(p.potential_temperature[i] > 100.0 && p.potential_temperature[i] < 1000.0)) {
      throw std::invalid_argument("potential_temperature must be in kelvin");
    }
    check_finite(p.wind[i], "wind");
    if (!p.water.empty() && !(p.water[i] >= 0.0 && p.water[i] < 0.1)) {
      throw std::invalid_argument("water must be 0 to 0.1 kg/kg");
    }
  }
}

} // namespace

double interpolated(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto above = std::upper_bound(x.begin(), x.end(), at);
  if (above == x.begin()) {
    return y.front();
  }
  if (above == x.end()) {
    return y.back();
  }
  const auto i = static_cast<std::size_t>(above - x.begin());
  const double share = (at - x[i - 1]) / (x[i] - x[i - 1]);
  return y[i - 1] + share * (y[i] - y[i - 1]);
}

Terrain::Terrain(const Lattice& lattice, std::vector<double> height)
    : nx_(lattice.nx), top_(lattice.top()) {
  mean_ = height.empty() ? 0.0
                         : std::accumulate(height.begin(), height.end(), 0.0) /
                               static_cast<double>(height.size());
  take(lattice, height);
}

Terrain::Terrain(const Lattice& lattice, std::vector<double> height, const Terrain& around)
    : nx_(lattice.nx), mean_(around.mean_), top_(around.top_) {
  take(lattice, height);
}

void Terrain::take(const Lattice& lattice, const std::vector<double>& height) {
  above_.resize(static_cast<std::size_t>(lattice.nx * lattice.ny));
  if (height.empty()) {
    return;
  }
  check_finite(height, "ground");
  std::transform(height.begin(), height.end(), above_.begin(), [&](double h) { return h - mean_; });
  flat_ = std::all_of(above_.begin(), above_.end(), [](double h) { return h == 0.0; });
  if (std::any_of(above_.begin(), above_.end(),
                  [&](double h) { return std::abs(h) > 0.5 * top_; })) {
    throw std::invalid_argument(
        "ground must differ from its mean by less than half the height of the domain");
  }
}

Ambient::Ambient(const Lattice& lattice, const Terrain& ground, const Profile& profile)
    : moist_(!profile.water.empty()), reference_(0.0), theta_(lattice, lattice.nz),
      water_(lattice, moist_ ? lattice.nz : 0), virtual_theta_(lattice, moist_ ? lattice.nz : 0) {
  check_profile(profile);
  reference_ = std::round(interpolated(profile.height, profile.potential_temperature, 0.0));
  set_hydrostatic(lattice, profile);
  set_wind(lattice, profile);
  rest(lattice, ground, profile);
}

/// Integrates hydrostatic balance: d(Exner function) / dz = -g / (cp theta).
void Ambient::set_hydrostatic(const Lattice& lattice, const Profile& p) {
  const auto theta = [&](double z) { return interpolated(p.height, p.potential_temperature, z); };
  double exner = std::pow(p.pressure / constants::reference_pressure,
                          constants::gas_constant / constants::specific_heat);
  double height = 0.0;
  const auto rise_to = [&](double z) {
    const double mean = 0.5 * (theta(height) + theta(z));
    exner -= constants::gravity * (z - height) / (constants::specific_heat * mean);
    height = z;
    if (!(exner > 0.05)) {
      throw std::invalid_argument(
          "levels extend above the atmosphere; lower the top of the domain");
    }
    return constants::reference_pressure *
           std::pow(exner, constants::specific_heat / constants::gas_constant);
  };
  const auto dense = [&](double pressure, double z) {
    return pressure / (constants::gas_constant * exner * theta(z));
  };
  for (std::size_t k = 0; k < lattice.face.size(); ++k) {
    air_.face.push_back(static_cast<float>(dense(rise_to(lattice.face[k]), lattice.face[k])));
    if (k < lattice.middle.size()) {
      pressure_.push_back(rise_to(lattice.middle[k]));
      exner_.push_back(exner);
      density_.push_back(dense(pressure_.back(), lattice.middle[k]));
      air_.cell.push_back(static_cast<float>(density_.back() * lattice.depth[k]));
    }
  }
}

std::vector<std::array<float, 2>> Ambient::set_wind(const Lattice& lattice, const Profile& p) {
  const std::vector<double> east = part(p.wind, 0), north = part(p.wind, 1);
  std::vector<std::array<float, 2>> change(lattice.middle.size());
  wind_.resize(change.size());
  for (std::size_t k = 0; k < change.size(); ++k) {
    const double z = lattice.middle[k];
    const std::array<float, 2> now{static_cast<float>(interpolated(p.height, east, z)),
                                   static_cast<float>(interpolated(p.height, north, z))};
    change[k] = {now[0] - wind_[k][0], now[1] - wind_[k][1]};
    wind_[k] = now;
  }
  return change;
}

void Ambient::rest(const Lattice& lattice, const Terrain& ground, const Profile& p) {
  each(lattice.nz, [&](Index k) {
    const double height = lattice.middle[static_cast<std::size_t>(k)];
    std::vector<float> cloud(static_cast<std::size_t>(lattice.nx));
    for (Index j = -halo; j < lattice.ny + halo; ++j) {
      for (Index i = -halo; i < lattice.nx + halo; ++i) {
        const Index row = std::clamp(j, Index{0}, lattice.ny - 1);
        const Index column = std::clamp(i, Index{0}, lattice.nx - 1);
        const double z = height + ground.above(row, column) * ground.share(height);
        const double theta = interpolated(p.height, p.potential_temperature, z) - reference_;
        const double water = moist_ ? interpolated(p.height, p.water, z) : 0.0;
        theta_.row(k, j)[i] = static_cast<float>(theta);
        if (moist_) {
          water_.row(k, j)[i] = static_cast<float>(water);
        }
      }
      if (moist_) {
        virtual_row(lattice.nx, theta_.row(k, j), water_.row(k, j), level_reference(k),
                    virtual_theta_.row(k, j), cloud.data());
      }
    }
  });
}

} // namespace firetwin::flow
