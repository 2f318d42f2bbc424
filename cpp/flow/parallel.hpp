#pragma once

#include "flow/lattice.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <vector>

namespace firetwin::flow {

/// Calls f(i) for 0 <= i < count on many threads. Calls must write to disjoint memory, so that the
/// result does not depend on the number of threads.
template <class Function> void each(Index count, const Function& f) {
  tbb::parallel_for(Index{0}, count, f);
}

/// Sums f(i) in float64 in the order of i, for any number of threads.
template <class Function> double sum_each(Index count, const Function& f) {
  std::vector<double> parts(static_cast<std::size_t>(count));
  each(count, [&](Index i) { parts[static_cast<std::size_t>(i)] = f(i); });
  double sum = 0.0;
  for (const double part : parts) {
    sum += part;
  }
  return sum;
}

/// Returns the largest f(i), at least 0.
template <class Function> double max_each(Index count, const Function& f) {
  std::vector<double> parts(static_cast<std::size_t>(count));
  each(count, [&](Index i) { parts[static_cast<std::size_t>(i)] = f(i); });
  double most = 0.0;
  for (const double part : parts) {
    most = part > most ? part : most;
  }
  return most;
}

} // namespace firetwin::flow
