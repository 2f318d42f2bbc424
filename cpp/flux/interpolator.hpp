#pragma once

#include "flux/recent.hpp"
#include "flux/step.hpp"
#include "run/run.hpp"

#include <cstddef>
#include <memory>
#include <mutex>
#include <vector>

namespace firetwin::flux {

/// The heat flux of the fire at any time. Cells with less flux than a fire's (run::least_fire) that
/// it has not reached do not burn.
///
/// It keeps what it has read: a moment costs what burns in it, and frames asked for in order are
/// read once each. What a moment gives does not depend on those before it, nor on the number of
/// threads, any of which may ask at once.
class Interpolator {
public:
  /// Finds when cells begin to burn, see arrival.hpp.
  explicit Interpolator(std::shared_ptr<const run::Run> run);

  const run::Run& run() const { return *run_; }

  /// What burns at `time` (s since start): the frame at a model time, between two of them as in
  /// Step; nothing before the first and after the last.
  /// @throws std::invalid_argument when time is NaN.
  Frame at(double time) const;

private:
  std::shared_ptr<const Frame> frame(std::size_t index) const;
  std::shared_ptr<const Step> step(std::size_t index) const;
  Frame read(std::size_t index) const;

  std::shared_ptr<const run::Run> run_;
  std::vector<double> begin_; ///< [ny nx] s

  mutable std::mutex mutex_; ///< for all below
  mutable Recent<Frame, 4> frames_;
  mutable Recent<Step, 3> steps_;
  mutable std::vector<float> values_; ///< [ny nx] of the frame being read
};

} // namespace firetwin::flux
