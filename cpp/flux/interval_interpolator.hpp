#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::flux {

/// Sparse heat flux: the cells of a grid with nonzero flux, ascending.
struct SparseFlux {
  std::vector<std::int64_t> cell; ///< y nx + x
  std::vector<float> flux;        ///< W/m2; NaN if the model has no value
};

/// Interpolation of heat flux in the interval between two model times.
///
/// Size and colour of the flames follow F^1.5 (see emitters.hpp), so the sum of F^1.5 changes
/// linearly between model times, and brightness does not pulse with the model step:
/// - In a cell that burned before, F^1.5 changes linearly.
/// - A cell that ignites in the interval stays cold until the front arrives, so that the front
///   moves continuously. Its F^1.5 then rises during a fraction of the interval equal to its share
///   in the F^1.5 of all new cells. If they rose one after the other in the order of arrival, their
///   sum would rise linearly. It may deviate by a few percent of the other cells' sum; arrivals
///   with a larger deviation are shifted.
/// - One factor for all cells, within 5 % of F^1.5, corrects the remaining deviation.
///
/// The result is NaN if a cell that burned before is NaN in one of the two frames. Negative fluxes
/// are excluded and change linearly.
class IntervalInterpolator {
public:
  /// @param begin [ny nx] ignition times, s; NaN: half-way
  /// @param start, end model times of the frames, s
  IntervalInterpolator(const SparseFlux& before, const SparseFlux& after,
                       std::span<const double> begin, double start, double end);

  /// @param fraction of the interval, 0 to 1
  SparseFlux at(double fraction) const;

private:
  enum class Course : std::uint8_t { even, begins, linear };
  struct Cell {
    std::int64_t cell;
    float before, after;                ///< W/m2
    double bright_before, bright_after; ///< F^1.5
    Course course = Course::even;
  };
  /// A cell that ignites in the interval.
  struct Beginning {
    std::size_t index; ///< in cells_
    double time;       ///< fraction of the interval
  };

  void add(std::int64_t cell, float before, float after, double begin);
  double rise(double fraction, double arrival, double turn, double share) const;
  double light(double fraction, std::vector<double>& brightness) const;

  double start_, end_;
  std::vector<Cell> cells_;
  std::vector<Beginning> beginnings_;         ///< ascending
  double old_before_ = 0.0, old_after_ = 0.0; ///< F^1.5 of the cells that burned before
  double new_ = 0.0;                          ///< final F^1.5 of the cells that ignite
  double leeway_ = 0.0;                       ///< fraction of the interval
};

} // namespace firetwin::flux
