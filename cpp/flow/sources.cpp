#include "flow/sources.hpp"

#include "base/interpolation.hpp"
#include "base/random.hpp"
#include "base/smoothstep.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

namespace firetwin::flow {
namespace {

/// Returns the standard normal value of a lattice point of the noise (Box and Muller 1958).
double lattice_value(std::uint64_t seed, std::int64_t x, std::int64_t y, std::int64_t t) {
  const auto bits = philox({static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y),
                            static_cast<std::uint64_t>(t), 0},
                           {seed, 0x67757374}); // "gust"
  return std::sqrt(-2.0 * std::log(1.0 - unit(bits[0]))) *
         std::cos(2.0 * std::numbers::pi * unit(bits[1]));
}

/// Evaluates Gaussian noise of unit variance, smooth in x, y and t, with correlation length 1.
double noise(std::uint64_t seed, const std::array<double, 3>& at) {
  std::array<std::int64_t, 3> low{};
  std::array<double, 3> part{};
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = static_cast<std::int64_t>(std::floor(at[a]));
    part[a] = smoothstep(0.0, 1.0, at[a] - static_cast<double>(low[a]));
  }
  double sum = 0.0, squares = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    std::array<std::int64_t, 3> place = low;
    for (std::size_t a = 0; a < 3; ++a) {
      const bool upper = (corner >> a) & 1;
      weight *= upper ? part[a] : 1.0 - part[a];
      place[a] += upper;
    }
    if (weight > 0.0) {
      sum += weight * lattice_value(seed, place[0], place[1], place[2]);
      squares += weight * weight;
    }
  }
  return sum / std::sqrt(squares);
}

/// Computes the gust factor of each source.
std::vector<double> factors(const Sources& sources, const Gusts& gusts, double time) {
  std::vector<double> result(sources.heat.size(), 1.0);
  for (std::size_t i = 0; gusts.strength > 0.0 && i < result.size(); ++i) {
    result[i] = gust(gusts, sources.position[i][0], sources.position[i][1], time);
  }
  return result;
}

/// Multiplies amounts by their factors and conserves the sum of the amounts.
std::vector<double> apply_factors(const std::vector<double>& amount,
                                  const std::vector<double>& factor) {
  const double before = std::accumulate(amount.begin(), amount.end(), 0.0);
  const double after = std::inner_product(amount.begin(), amount.end(), factor.begin(), 0.0);
  std::vector<double> result(amount.size());
  for (std::size_t i = 0; i < amount.size(); ++i) {
    result[i] = after > 0.0 ? amount[i] * factor[i] * (before / after) : 0.0;
  }
  return result;
}

} // namespace

double gust(const Gusts& gusts, double x, double y, double time) {
  const double g = noise(gusts.seed, {x / gusts.size, y / gusts.size, time / gusts.time});
  return std::exp(gusts.strength * (g - 0.5 * gusts.strength));
}

Deposit deposit(const Sources& sources, const Lattice& lattice, const std::array<double, 2>& origin,
                const Gusts& gusts, double time) {
  const auto columns = static_cast<std::size_t>(lattice.nx * lattice.ny);
  Deposit result{std::vector<double>(columns), std::vector<double>(columns),
                 std::vector<double>(sources.water.empty() ? 0 : columns)};
  const std::vector<double> factor = factors(sources, gusts, time);
  const auto heat = apply_factors(sources.heat, factor),
             smoke = apply_factors(sources.smoke, factor);
  const auto water = apply_factors(sources.water, factor);
  for (std::size_t n = 0; n < sources.position.size(); ++n) {
    const double x = (sources.position[n][0] - origin[0]) / lattice.spacing - 0.5;
    const double y = (sources.position[n][1] - origin[1]) / lattice.spacing - 0.5;
    if (!(x >= 0.0 && y >= 0.0 && x < static_cast<double>(lattice.nx - 1) &&
          y < static_cast<double>(lattice.ny - 1))) {
      continue;
    }
    const auto i = static_cast<Index>(x), j = static_cast<Index>(y);
    const double a = x - static_cast<double>(i), b = y - static_cast<double>(j);
    const auto weights = bilinear_weights(b, a);
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const double weight = weights[corner];
      const auto right = static_cast<Index>(corner % 2), up = static_cast<Index>(corner / 2);
      const auto column = static_cast<std::size_t>((j + up) * lattice.nx + i + right);
      result.heat[column] += weight * heat[n];
      result.smoke[column] += weight * smoke[n];
      if (!sources.water.empty()) {
        result.water[column] += weight * water[n];
      }
    }
  }
  return result;
}

std::vector<double> shares(const Lattice& lattice, double depth) {
  std::vector<double> result(lattice.middle.size());
  for (std::size_t k = 0; k < result.size(); ++k) {
    result[k] = std::exp(-lattice.face[k] / depth) - std::exp(-lattice.face[k + 1] / depth);
  }
  const double sum = std::accumulate(result.begin(), result.end(), 0.0);
  for (double& share : result) {
    share = share > 1e-4 * sum ? share / sum : 0.0; // higher levels cost time without effect
  }
  const double kept = std::accumulate(result.begin(), result.end(), 0.0);
  for (double& share : result) {
    share /= kept;
  }
  return result;
}

} // namespace firetwin::flow
