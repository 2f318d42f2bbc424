#pragma once

#include "flow/lattice.hpp"

#include <array>

/// Vectorised operations on one row of numbers. Rows must not overlap unless stated otherwise.
/// Functions that only write a row may process complete SIMD lanes of it.
namespace firetwin::flow {

/// Rows whose mean is the row at a position of the staggered grid; at cell centres one row twice.
struct Pair {
  const float* a;
  const float* b;
};

/// Rows of air around n faces: of the faces and cells themselves, and of those one place before.
struct AirRows {
  Pair flux_before;
  Pair flux;
  Pair mass_before;
  Pair mass;
};

/// The four rows next to n faces: two below, two above. They may overlap each other.
struct Stencil {
  const float* low2;
  const float* low;
  const float* high;
  const float* high2;
};

/// Results at n faces.
struct FaceRows {
  float* flux;    ///< air that passes; not written if the pair of fluxes is one row
  float* inverse; ///< 1 / (mass + in - out) of the cells before the faces
  float* value;   ///< of q
  float* mixed;   ///< eddy fluxes of q
};

/// Rows of n cells: air that passes their lower and upper faces, face values, and eddy fluxes.
struct CellRows {
  const float* in;
  const float* out;
  const float* low;
  const float* high;
  const float* mixed_low;
  const float* mixed_high;
  const float* inverse; ///< 1 / air after the sweep
  const float* mass;    ///< air before the sweep; null: not rescaled
  float rest;           ///< air to which q is rescaled
};

/// out = from x factor
void scale_row(Index n, const float* from, float factor, float* out);

/// Computes face values: the upwind value plus a slope, third order in space and time for smooth
/// fields, limited to 2 (q - q_upwind) on both sides so that no new extremes appear (Arora and Roe
/// 1997, "A well-behaved TVD limiter for high-resolution calculations of unsteady flow", J. Comput.
/// Phys. 132; the bounds are the MC limiter's). Computes also the air that passes, and the eddy
/// fluxes: exchange x mixing x (q above - q below). One loop hides its divisions. Processes full
/// lanes.
void face_row(Index n, const AirRows& air, const Pair& exchange, float mixing, const Stencil& q,
              const FaceRows& faces);

/// Updates q by advection: `in` enters with values `low` through the lower faces, `out` leaves with
/// values `high` through the upper ones. A constant field stays constant, bit for bit. Then adds
/// eddy fluxes, and rescales q to q x (mass + in - out) / rest, so that q x rest is q x air.
void update_row(Index n, const CellRows& cells, float* q);

/// Air that cells keep, by lane.
struct KeptAir {
  std::array<float, lanes> least_first;  ///< after one direction
  std::array<float, lanes> least_second; ///< after the second direction / after the first
  std::array<float, lanes> most_second;
};

/// Computes the air of cells after one direction and after two: rest + in - out. Processes full
/// lanes; cells after the n-th one keep `rest`.
void drain_row(Index n, const std::array<const float*, 2>& in,
               const std::array<const float*, 2>& out, float rest, float* first, float* second,
               KeptAir& kept);

/// Computes the air that eddies exchange between two rows of cells with eddy viscosities K: their
/// mean x factor, at most the share `most` of the least of `air`.
void exchange_row(Index n, const std::array<const float*, 2>& strength,
                  const std::array<const float*, 4>& air, float factor, float most, float* out);

/// out = (right - left) x a + (back - front) x b + above x c - below x d
struct Faces {
  const float* left;
  const float* right;
  const float* front;
  const float* back;
  const float* below;
  const float* above;
};
void divergence_row(Index n, const Faces& faces, float across, float above, float below,
                    float* out);

/// q -= (high - low) x scale
void subtract_gradient_row(Index n, const float* high, const float* low, float scale, float* q);

/// Adds dt x smoke to smoke x age, limited to smoke x oldest: in traces of smoke the limiter may
/// treat the two fields differently.
void age_row(Index n, const float* smoke, float dt, float oldest, float* age);

/// q += (target - q) x weight x share
void relax_row(Index n, float target, const float* weight, float share, float* q);
void relax_row(Index n, const float* target, const float* weight, float share, float* q);
void relax_row(Index n, const float* target, float share, float* q);

/// Returns whether a row has a value other than 0.
bool has_nonzero_row(Index n, const float* q);

/// Returns the largest |q| (NaN if a value is NaN).
float max_abs_row(Index n, const float* q);

/// Sums a row in float64.
double sum_row(Index n, const float* q);

} // namespace firetwin::flow
