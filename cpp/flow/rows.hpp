#pragma once

#include "flow/lattice.hpp"

#include <array>

/// Vectorised operations on one row of numbers. Rows must not overlap unless stated otherwise.
/// Functions that only write a row may process complete SIMD lanes of it.
namespace firetwin::flow {

/// The four rows next to n faces: two below, two above. They may overlap each other.
struct Stencil {
  const float* low2;
  const float* low;
  const float* high;
  const float* high2;
};

/// out = from x factor
void scale_row(Index n, const float* from, float factor, float* out);

/// left = mass + in - out
void remaining_row(Index n, const float* mass, const float* in, const float* out, float* left);

/// Computes the mean of two rows.
void mean_row(Index n, const float* a, const float* b, float* out);

/// Computes Courant numbers of faces: the share of the upwind cell's air that passes, at most 1.
/// `low` and `high` are the masses of the cells below and above the faces.
void courant_row(Index n, const float* flux, const float* low, const float* high, float* courant);

/// Computes face values: the upwind value plus a slope, third order in space and time for smooth
/// fields, limited to 2 (q - q_upwind) on both sides so that no new extremes appear (Arora and Roe
/// 1997, "A well-behaved TVD limiter for high-resolution calculations of unsteady flow", J. Comput.
/// Phys. 132; the bounds are the MC limiter's).
void face_row(Index n, const float* flux, const float* courant, const Stencil& q, float* value);

/// 1 / (mass + in - out)
void inverse_row(Index n, const float* mass, const float* in, const float* out, float* inverse);

/// Computes the air that eddies exchange between two rows of cells with eddy viscosities K: their
/// mean x factor, at most the share `most` of the least of `air`.
void exchange_row(Index n, const std::array<const float*, 2>& strength,
                  const std::array<const float*, 4>& air, float factor, float most, float* out);

/// Computes the eddy flux through each face: exchange x (q above - q below) x factor.
void mixing_flux_row(Index n, const float* exchange, float factor, const float* low,
                     const float* high, float* mixed);

/// Updates q by eddy fluxes: `high` enters through the upper faces, `low` leaves through the lower
/// ones.
void mix_row(Index n, const float* low, const float* high, const float* inverse, float* q);

/// Updates q by advection: `in` enters with values `low` through the lower faces, `out` leaves with
/// values `high` through the upper ones. A constant field stays constant, bit for bit.
void advect_row(Index n, const float* in, const float* out, const float* low, const float* high,
                const float* inverse, float* q);

/// Computes q x (mass + in - out) / base, so that q x base is the former q x air mass.
void rescale_row(Index n, const float* mass, const float* in, const float* out, float base,
                 float* q);

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

/// Returns the smallest part / whole.
float min_ratio_row(Index n, const float* part, const float* whole);

/// Sums a row in float64.
double sum_row(Index n, const float* q);

} // namespace firetwin::flow
