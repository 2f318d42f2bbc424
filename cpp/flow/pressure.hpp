#pragma once

#include "base/huge_pages.hpp"
#include "flow/cosine_transform.hpp"
#include "flow/transport.hpp"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <vector>

namespace firetwin::flow {

/// Pressure projection: removes the divergence of rho u by a pressure gradient. The wind through
/// the domain's own faces is unchanged. The Poisson equation is solved directly, by cosine
/// transforms along x and y (Neumann conditions) and a tridiagonal system along z for each mode
/// (Schumann and Sweet 1988, "Fast Fourier transforms for direct solution of Poisson's equation
/// with staggered boundary conditions", J. Comput. Phys. 75).
class Pressure {
public:
  Pressure(const Lattice& lattice, const Air& air);

  void project(Wind& wind);

  /// Returns the largest |div(rho u)| / rho of a wind, 1/s.
  double divergence(const Wind& wind) const;

private:
  template <class Place> void diverge(const Wind& wind, Index k, const Place& place) const;
  void transform(const Wind& wind, Index k);
  void transform_back(Index k);
  void solve();
  void solve_modes(Index begin, Index end);
  void descend(Wind& wind) const;
  float* level(Index k) { return modes_.data() + k * size_; }
  const float* level(Index k) const { return modes_.data() + k * size_; }

  const Lattice& lattice_;
  const Air& air_;
  Index size_; ///< floats between levels of modes
  HugeVector<float> modes_;
  HugeVector<float> pivot_;          ///< [nz][modes] inverse pivots of the elimination
  std::vector<float> below_, above_; ///< [nz] coefficients of the levels below and above
  CosineTransform along_x_, along_y_;
  tbb::enumerable_thread_specific<CosineTransform::Rows> x_room_, y_room_;
};

} // namespace firetwin::flow
