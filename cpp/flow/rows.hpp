#pragma once

#include "flow/lattice.hpp"

#include <array>

/// What is done to one row of numbers at a time, in lanes. Rows do not overlap unless said. Those
/// that only make a row may be asked for whole lanes of it.
namespace firetwin::flow {

/// The four rows beside n faces: two below, two above. They may overlap each other.
struct Stencil {
  const float* low2;
  const float* low;
  const float* high;
  const float* high2;
};

/// out = from x factor
void scale_row(Index n, const float* from, float factor, float* out);

/// left = mass + in - out
void left_row(Index n, const float* mass, const float* in, const float* out, float* left);

/// Mean of two rows.
void mean_row(Index n, const float* a, const float* b, float* out);

/// Share of the upwind cell's air that a face lets through, at most 1. Masses are of the cells
/// below and above the faces.
void courant_row(Index n, const float* flux, const float* low, const float* high, float* courant);

/// What flows through each face: the upwind value and a slope, third order in space and time where
/// it is smooth, held within 2 (q - q_upwind) on both sides so that no new extreme appears
/// (Arora and Roe 1997, "A well-behaved TVD limiter for high-resolution calculations of unsteady
/// flow", J. Comput. Phys. 132; the bounds are the MC limiter's).
void face_row(Index n, const float* flux, const float* courant, const Stencil& q, float* value);

/// 1 / (mass + in - out)
void inverse_row(Index n, const float* mass, const float* in, const float* out, float* inverse);

/// Air that eddies exchange between two rows of cells of strengths K: their mean x factor, at most
/// the share `most` of the least of `air`.
void exchange_row(Index n, const std::array<const float*, 2>& strength,
                  const std::array<const float*, 4>& air, float factor, float most, float* out);

/// What eddies bring through each face: exchange x (q above - q below) x factor.
void mixed_row(Index n, const float* exchange, float factor, const float* low, const float* high,
               float* mixed);

/// q after eddies brought `high` through the upper faces and took `low` through the lower ones.
void stir_row(Index n, const float* low, const float* high, const float* inverse, float* q);

/// q after `in` came with `low` through the lower faces and `out` left with `high` through the
/// upper ones. A constant stays what it is, to the bit.
void carry_row(Index n, const float* in, const float* out, const float* low, const float* high,
               const float* inverse, float* q);

/// q x (mass + in - out) / base: q x base is then what q x the air was.
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
void descend_row(Index n, const float* high, const float* low, float scale, float* q);

/// Smoke x age after dt, at most smoke x oldest: where there is next to none of it, the limiter may
/// treat the two unlike.
void grow_old_row(Index n, const float* smoke, float dt, float oldest, float* age);

/// q += (target - q) x weight x share
void relax_row(Index n, float target, const float* weight, float share, float* q);
void relax_row(Index n, const float* target, const float* weight, float share, float* q);
void relax_row(Index n, const float* target, float share, float* q);

/// Whether there is anything but 0.
bool something_row(Index n, const float* q);

/// Largest |q| (not a number if one is not).
float most_row(Index n, const float* q);

/// Smallest part / whole.
float least_share_row(Index n, const float* part, const float* whole);

/// Sum in float64.
double sum_row(Index n, const float* q);

} // namespace firetwin::flow
