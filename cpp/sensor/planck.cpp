#include "sensor/planck.hpp"

#include "base/constants.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace firetwin::sensor {
namespace {

/// h c / k in um K: x = second / (lambda T).
constexpr double second =
    constants::planck * constants::speed_of_light / constants::boltzmann * 1e6;

/// 2 k^4 / (h^3 c^2) in W m-2 sr-1 K-4: radiance = first T^4 (integral of x^3 / (e^x - 1) over x).
double first() {
  const double k = constants::boltzmann, h = constants::planck, c = constants::speed_of_light;
  return 2.0 * (k / h) * (k / h) * (k / h) * k / (c * c);
}

/// 2 h c^2 / lambda^5 in W m-2 sr-1 um-1, for lambda in um.
double scale(double wavelength) {
  const double square = wavelength * wavelength;
  return 2.0 * constants::planck * constants::speed_of_light * constants::speed_of_light * 1e24 /
         (square * square * wavelength);
}

/// x^3 / (e^x - 1)
double integrand(double x) {
  return x > 700.0 ? 0.0 : x * x * x / std::expm1(x);
}

/// Integral of the integrand from 0 to x <= 1, by its Taylor series (Bernoulli numbers B_2n/(2n)!).
double from_zero(double x) {
  constexpr std::array<double, 8> coefficient = {
      1.0 / 12.0,          -1.0 / 720.0,
      1.0 / 30240.0,       -1.0 / 1209600.0,
      1.0 / 47900160.0,    -691.0 / 1307674368000.0,
      1.0 / 74724249600.0, -3617.0 / 10670622842880000.0};
  const double x2 = x * x;
  double sum = 1.0 / 3.0 - x / 8.0;
  double power = x2;
  for (std::size_t n = 0; n < coefficient.size(); ++n, power *= x2) {
    sum += coefficient[n] * power / static_cast<double>(2 * n + 5);
  }
  return x2 * x * sum;
}

/// Integral from x >= 1 to infinity, term by term of 1/(e^x - 1) = sum of e^(-n x) (W. K. Widger
/// and M. P. Woodall 1976, Bulletin of the American Meteorological Society 57, 1217).
double to_infinity(double x) {
  double sum = 0.0;
  for (int n = 1; n < 60; ++n) {
    const double i = 1.0 / n;
    const double term =
        std::exp(-n * x) * (((x + 3.0 * i) * x + 6.0 * i * i) * x + 6.0 * i * i * i) * i;
    sum += term;
    if (term <= sum * 1e-17) {
      break;
    }
  }
  return sum;
}

/// Integral of x^3/(e^x - 1) from low to high.
double planck_integral(double low, double high) {
  constexpr double all =
      std::numbers::pi * std::numbers::pi * std::numbers::pi * std::numbers::pi / 15.0;
  if (high <= 1.0) {
    return from_zero(high) - from_zero(low);
  }
  return low <= 1.0 ? all - from_zero(low) - to_infinity(high)
                    : to_infinity(low) - to_infinity(high);
}

/// d(radiance)/dT, from radiance = first T^4 I(x_low(T), x_high(T)) with dx/dT = -x/T.
double slope(double kelvin, double radiance, const Band& band) {
  const double low = second / (band.high * kelvin), high = second / (band.low * kelvin);
  return 4.0 * radiance / kelvin +
         first() * kelvin * kelvin * kelvin * (low * integrand(low) - high * integrand(high));
}

/// Rayleigh-Jeans limit, where radiance is proportional to temperature; a lower bound of the
/// result.
double rayleigh_jeans(double radiance, const Band& band) {
  const double low = second / band.high, high = second / band.low;
  return radiance * 3.0 / (first() * (high * high * high - low * low * low));
}

} // namespace

void check(const Band& band) {
  if (!(band.low > 0.0) || !(band.high > band.low) || !std::isfinite(band.high)) {
    throw std::invalid_argument("a band needs two wavelengths in micrometres, 0 < low < high");
  }
}

double spectral_radiance(double kelvin, double wavelength) {
  if (!(kelvin > 0.0)) {
    return kelvin == 0.0 ? 0.0 : std::numeric_limits<double>::quiet_NaN();
  }
  return scale(wavelength) / std::expm1(second / (wavelength * kelvin));
}

double spectral_temperature(double radiance, double wavelength) {
  if (!(radiance > 0.0)) {
    return radiance == 0.0 ? 0.0 : std::numeric_limits<double>::quiet_NaN();
  }
  return second / (wavelength * std::log1p(scale(wavelength) / radiance));
}

double radiance(double kelvin, const Band& band) {
  if (!(kelvin > 0.0)) {
    return kelvin == 0.0 ? 0.0 : std::numeric_limits<double>::quiet_NaN();
  }
  if (std::isinf(kelvin)) {
    return kelvin;
  }
  const double squared = kelvin * kelvin;
  return first() * squared * squared *
         planck_integral(second / (band.high * kelvin), second / (band.low * kelvin));
}

double temperature_exponent(double kelvin, const Band& band) {
  const double value = radiance(kelvin, band);
  return slope(kelvin, value, band) * kelvin / value;
}

// Newton's method on log(radiance) against 1/T, which is nearly linear for large x; bisection if a
// step leaves the bracket.
double brightness_temperature(double target, const Band& band) {
  if (!(target > 0.0) || std::isinf(target)) {
    return target >= 0.0 ? target : std::numeric_limits<double>::quiet_NaN();
  }
  double low = rayleigh_jeans(target, band);
  double high = std::numeric_limits<double>::infinity();
  double kelvin = std::max(low, 300.0);
  for (int step = 0; step < 200; ++step) {
    const double value = radiance(kelvin, band);
    (value < target ? low : high) = kelvin;
    const double inverse = 1.0 / kelvin - std::log(target / value) * value /
                                              (kelvin * kelvin * slope(kelvin, value, band));
    double next = 1.0 / inverse;
    if (!(next > low && next < high)) {
      next = std::isinf(high) ? 2.0 * kelvin : 0.5 * (low + high);
    }
    if (std::abs(next - kelvin) <= 4e-16 * kelvin) {
      return next;
    }
    kelvin = next;
  }
  return kelvin;
}

} // namespace firetwin::sensor
