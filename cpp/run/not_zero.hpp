#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace firetwin::run {

/// Calls visit(i) for each nonzero value (including NaN) in order and returns their number. Most
/// heat fluxes are 0, so groups of values are tested at once.
template <class Visit>
std::size_t each_not_zero(std::span<const float> values, const Visit& visit) {
  constexpr std::size_t together = 64;
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < values.size(); begin += together) {
    const std::size_t end = std::min(begin + together, values.size());
    unsigned others = 0;
    for (std::size_t i = begin; i < end; ++i) {
      others += values[i] != 0.0F ? 1U : 0U;
    }
    for (std::size_t i = begin; others > 0 && i < end; ++i) {
      if (values[i] != 0.0F) {
        visit(i);
      }
    }
    count += others;
  }
  return count;
}

} // namespace firetwin::run
