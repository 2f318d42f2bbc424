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
/// reached does not burn if its flux is below run::min_fire_flux.
///
/// The cost is proportional to the number of burning cells. In sequential access each frame is read
/// once. The class is thread-safe, and results do not depend on the order of calls.
class Interpolator {
public:
  /// Computes ignition times (see arrival.hpp).
  explicit Interpolator(std::shared_ptr<const run::Run> run);

  const run::Run& run() const { return *run_; }

  /// Heat flux at `time` (s since start): the frame at a model time, interpolated by
  /// IntervalInterpolator in between, and empty before the first and after the last model time.
  /// @throws std::invalid_argument if time is NaN
  SparseFlux at(double time) const;

private:
  std::shared_ptr<const SparseFlux> frame(std::size_t index) const;
  std::shared_ptr<const IntervalInterpolator> step(std::size_t index) const;
  SparseFlux read(std::size_t index) const;

  std::shared_ptr<const run::Run> run_;
  std::vector<double> begin_; ///< [ny nx] s

  mutable std::mutex mutex_; ///< protects the members below
  mutable LruCache<SparseFlux, 4> frames_;
  mutable LruCache<IntervalInterpolator, 3> steps_;
  mutable std::vector<float> values_; ///< [ny nx] buffer of the frame being read
};

} // namespace firetwin::flux
