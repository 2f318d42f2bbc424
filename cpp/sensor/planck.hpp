#pragma once

namespace firetwin::sensor {

/// Wavelengths in micrometres.
struct Band {
  double low = 8.0;
  double high = 14.0;
};

/// @throws std::invalid_argument unless 0 < low < high are finite
void check(const Band& band);

/// Radiance of a black body at one wavelength (um), W m-2 sr-1 um-1: Planck's law. 0 K gives 0;
/// negative and NaN temperatures give NaN.
double spectral_radiance(double kelvin, double wavelength);

/// Temperature of a black body with this spectral radiance, K: the inverse in closed form. 0 gives
/// 0, infinity gives infinity; negative values and NaN give NaN.
double spectral_temperature(double radiance, double wavelength);

/// Radiance of a black body over a band, W m-2 sr-1: the integral of Planck's law
/// 2 h c^2 / (lambda^5 (exp(h c / (lambda k T)) - 1)), to about 1e-12 of its value for bands at
/// least a thousandth of their wavelength wide. 0 K gives 0; negative and NaN temperatures give
/// NaN.
double radiance(double kelvin, const Band& band);

/// Temperature exponent: d log(radiance) / d log(temperature) of a black body over a band, for
/// kelvin > 0.
double temperature_exponent(double kelvin, const Band& band);

/// Brightness temperature of a band radiance, K: the inverse of `radiance`. 0 gives 0, infinity
/// gives infinity; negative values and NaN give NaN.
double brightness_temperature(double radiance, const Band& band);

} // namespace firetwin::sensor
