#include "particles/motion.hpp"

#include "base/constants.hpp"

#include <cmath>

namespace firetwin::particles {
namespace {

/// The phi functions of exponential integrators (Hochbruck & Ostermann 2010, Acta Numerica 19,
/// doi:10.1017/S0962492910000048) at -s:
///   phi0 = e^-s, phi1 = (1 - phi0) / s, phi2 = (1 - phi1) / s, phi3 = (1/2 - phi2) / s.
struct Phi {
  double zero;
  double one;
  double two;
  double three;
};

/// The differences cancel for small s. There phi3 is its Taylor series, the sum of
/// (-s)^k / (k + 3)! = 1/6 (1 - s/4 (1 - s/5 (...))), and the others follow from it.
Phi phi(double s) {
  constexpr double few = 0.5;
  if (s > few) {
    const double one = -std::expm1(-s) / s;
    const double two = (1.0 - one) / s;
    return {std::exp(-s), one, two, (0.5 - two) / s};
  }
  double sum = 1.0;
  for (double k = 16.0; k >= 4.0; --k) {
    sum = 1.0 - s / k * sum;
  }
  const double three = sum / 6.0;
  const double two = 0.5 - s * three;
  const double one = 1.0 - s * two;
  return {1.0 - s * one, one, two, three};
}

} // namespace

double lift(double density, double air_density) {
  return constants::gravity * (air_density / density - 1.0);
}

Motion::State Motion::at(double t) const {
  const Phi p = t > 0.0 ? phi(t / relaxation) : phi(0.0);
  State state{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double a = i == 2 ? lift : 0.0;
    const double drift = wind[i] * (1.0 - p.zero) +
                         t * (a * p.one + gust[i] * (1.0 - p.one) + t * bend[i] * (0.5 - p.two));
    const double way = wind[i] * (1.0 - p.one) + t * (a * p.two + gust[i] * (0.5 - p.two) +
                                                      t * bend[i] * (1.0 / 6.0 - p.three));
    state.velocity[i] = velocity[i] * p.zero + drift;
    state.position[i] = position[i] + t * (velocity[i] * p.one + way);
  }
  return state;
}

} // namespace firetwin::particles
