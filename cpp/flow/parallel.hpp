#pragma once

#include "flow/lattice.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <vector>

namespace firetwin::flow {

/// f(i) for 0 <= i < count, on many threads. Each i writes what no other one does, so that any
/// number of threads gives the same.
template <class Function> void each(Index count, const Function& f) {
  tbb::parallel_for(Index{0}, count, f);
}

/// Sum of f(i), each in float64, added in the order of i whatever the threads.
template <class Function> double sum_each(Index count, const Function& f) {
  std::vector<double> parts(static_cast<std::size_t>(count));
  each(count, [&](Index i) { parts[static_cast<std::size_t>(i)] = f(i); });
  double sum = 0.0;
  for (const double part : parts) {
    sum += part;
  }
  return sum;
}

/// Largest f(i), at least 0.
template <class Function> double most_each(Index count, const Function& f) {
  std::vector<double> parts(static_cast<std::size_t>(count));
  each(count, [&](Index i) { parts[static_cast<std::size_t>(i)] = f(i); });
  double most = 0.0;
  for (const double part : parts) {
    most = part > most ? part : most;
  }
  return most;
}

} // namespace firetwin::flow
