#pragma once

#include "flux/interval_interpolator.hpp"
#include "flux/lru_cache.hpp"
#include "run/run.hpp"

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace firetwin::flux {

/// Heat flux of the fire at any time, with LRU caches of frames. A cell that the front has not
/// reached does not burn if its flux is below a fire's (run::least_fire).
///
/// The cost of a time is that of its burning cells. Frames in order are read once each. The class
/// is thread-safe, and the result does not depend on the order of calls.
class Interpolator {
public:
  /// Finds ignition times, see arrival.hpp.
  explicit Interpolator(std::shared_ptr<const run::Run> run);

  const run::Run& run() const { return *run_; }

  /// What burns at `time` (s since start): the frame at a model time, between two of them as in
  /// IntervalInterpolator; nothing before the first and after the last.
  /// @throws std::invalid_argument when time is NaN.
  SparseFlux at(double time) const;

private:
  std::shared_ptr<const SparseFlux> frame(std::size_t index) const;
  std::shared_ptr<const IntervalInterpolator> step(std::size_t index) const;
  SparseFlux read(std::size_t index) const;

  std::shared_ptr<const run::Run> run_;
  std::vector<double> begin_; ///< [ny nx] s

  mutable std::mutex mutex_; ///< for all below
  mutable LruCache<SparseFlux, 4> frames_;
  mutable LruCache<IntervalInterpolator, 3> steps_;
  mutable std::vector<float> values_; ///< [ny nx] of the frame being read
};

} // namespace firetwin::flux
