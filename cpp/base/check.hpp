#pragma once

#include <span>
#include <string>

/// Argument checks with uniform messages. @throws std::invalid_argument
namespace firetwin {

void check_finite(double value, const std::string& name);
void check_above_zero(double value, const std::string& name);   ///< and finite
void check_zero_or_more(double value, const std::string& name); ///< and finite
void check_finite(std::span<const double> values, const std::string& name);

} // namespace firetwin
