#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace firetwin::flux {

/// Sparse heat flux: the cells of a grid whose flux is not 0, in order.
struct SparseFlux {
  std::vector<std::int64_t> cell; ///< y nx + x
  std::vector<float> flux;        ///< W/m2; NaN where the model has none
};

/// Interpolation of heat flux in the interval between two model times.
///
/// Size and colour of the flames go with F^1.5 (see emitters.hpp), so between two model times the
/// sum of F^1.5 changes linearly, and nothing pulses once a model step:
/// - In a cell that burned before, F^1.5 changes linearly.
/// - A cell that first burns in between stays cold until the front arrives, so the
///   front moves instead of lighting all its new cells at once. Its F^1.5 then rises over the share
///   of the interval that it has in the F^1.5 of all new cells. Lit one after the other in this
///   way, in the order of their arrival, the sum of the new cells would rise linearly. They may be
///   ahead of that or behind it by a few percent of what the other cells have; an arrival that asks
///   for more is moved.
/// - What is then still off is made good by one factor for all cells, within 5 % for F^1.5.
///
/// NaN where a cell that burned before has NaN in one of the two frames. Cells below 0 take no part
/// in this and change linearly.
class IntervalInterpolator {
public:
  /// @param begin [ny nx] s, when cells begin to burn; NaN: half-way
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
  /// A cell that begins to burn.
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
  double new_ = 0.0;                          ///< F^1.5 that those that begin have in the end
  double leeway_ = 0.0;                       ///< fraction of the interval
};

} // namespace firetwin::flux
