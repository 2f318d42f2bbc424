#include "base/check.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace firetwin {
namespace {

void check(bool good, const std::string& name, const char* what) {
  if (!good) {
    throw std::invalid_argument(name + what);
  }
}

} // namespace

void check_finite(double value, const std::string& name) {
  check(std::isfinite(value), name, " must be finite");
}

void check_above_zero(double value, const std::string& name) {
  check(std::isfinite(value) && value > 0.0, name, " must be finite and above 0");
}

void check_zero_or_more(double value, const std::string& name) {
  check(std::isfinite(value) && value >= 0.0, name, " must be finite and 0 or more");
}

void check_finite(std::span<const double> values, const std::string& name) {
  check(std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }), name,
        " must be finite");
}

} // namespace firetwin
