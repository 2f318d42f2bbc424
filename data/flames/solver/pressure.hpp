#pragma once

#include "grid.hpp"

#include <memory>

namespace flame_solver {

/// Makes the divergence of a velocity equal to the expansion of the gas.
///
/// Poisson's equation by transforms (FFTW): the ground is closed, the top open; along x open at
/// both ends or, with wind, with a given inflow and an open outflow.
class Pressure {
public:
  Pressure(int nx, int ny, int nz, bool inflow);
  ~Pressure();
  Pressure(const Pressure&) = delete;
  Pressure& operator=(const Pressure&) = delete;

  /// Corrects a velocity; `expansion` is its divergence afterwards times the edge of a cell.
  void project(Velocity& flow, const Grid& expansion);

private:
  struct Plans;
  void solve();
  void correct(Velocity& flow) const;

  bool inflow_;
  Grid pressure_;
  std::vector<double> along_x_, along_y_, along_z_; ///< eigenvalues of second differences
  std::unique_ptr<Plans> plans_;
};

/// Largest difference between the divergence of a velocity, times a cell, and `expansion`.
float divergence_error(const Velocity& flow, const Grid& expansion);

} // namespace flame_solver
