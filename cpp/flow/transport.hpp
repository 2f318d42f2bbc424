#pragma once

#include "flow/field.hpp"
#include "flow/sweep.hpp"

#include <array>
#include <span>
#include <vector>

namespace firetwin::flow {

/// Velocity on the faces, m/s.
struct Wind {
  explicit Wind(const Lattice& lattice)
      : u(lattice, lattice.nz), v(lattice, lattice.nz), w(lattice, lattice.nz + 1) {}
  Field u;
  Field v;
  Field w;
};

/// Air mass of the ambient state.
struct Air {
  std::vector<float> cell; ///< [nz] kg per m2 of ground, in a cell
  std::vector<float> face; ///< [nz + 1] kg/m3 at the faces
};

/// Inverse turbulent Prandtl number: eddy diffusivity of scalars / eddy viscosity.
inline constexpr float scalar_mixing = 3.0F;

/// Advection of scalars and momentum with dimensional splitting: directions alternate their order
/// from step to step (after Strang 1968). Substeps keep each direction's Courant number below 0.8.
class Transport {
public:
  Transport(const Lattice& lattice, const Air& air);

  /// @param scalars 3 to `max_fields`, the first two of them 0 in most of the domain. Sums are
  /// conserved to rounding, except of the last `unconserved` ones, for which constants stay
  /// constant
  /// @param crossed [scalars] amounts that entered and left through the boundaries, value x kg
  /// @param mixing eddy viscosity of cells, m2/s; null in all steps of a flow without eddies
  /// @return number of substeps
  int advance(Wind& wind, std::span<Field* const> scalars, std::size_t unconserved, double dt,
              bool backwards, std::span<BoundaryFlux> crossed, const Field* mixing);

  double courant() const { return courant_; } ///< of the last complete step

private:
  int prepare(const Wind& wind, const Field* mixing, double dt, bool backwards);
  double prepare_level(const Wind& wind, const Field* mixing, double dt, bool backwards, Index k);
  double max_courant(const Wind& wind, double dt) const;
  void exchange_faces(Axis axis, const Field& mixing, double dt, Index k, Index j);
  /// Fields that a substep advects; the first `conserved` scalars are rescaled to the air at rest.
  struct Advected {
    std::array<Field*, 3> wind;
    std::span<Field* const> scalars;
    std::size_t conserved;
  };
  std::array<Sweep, 4> sweeps(Axis axis, const Field& mass, bool last,
                              const Advected& fields) const;
  void levels(const Advected& fields, bool backwards, std::span<BoundaryFlux> crossed);
  void columns(const Advected& fields, bool backwards);
  const Field& flux(Axis axis) const;
  const Field& exchange(Axis axis) const;

  const Lattice& lattice_;
  const Air& air_;
  Field x_, y_, z_;             ///< through faces in a substep, kg per m2 of ground
  Field rest_, first_, second_; ///< air of cells at rest, after one direction, after two
  Field mix_x_, mix_y_, mix_z_; ///< air exchanged by eddies through faces in a substep, kg/m2
  std::vector<BoundaryFlux> crossed_;
  double courant_ = 0.0;
};

} // namespace firetwin::flow
