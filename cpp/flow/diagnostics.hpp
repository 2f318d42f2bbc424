#pragma once

#include "flow/solver.hpp"

#include <span>

/// Diagnostic fields of a flow at cell centres, [nz][ny][nx].
namespace firetwin::flow {

/// Smoke density, kg/m3 of true volume: layers are thinner over high ground.
void smoke_density(const Solver& solver, std::span<float> out);

/// Mean age of the smoke since emission, s; 0 without smoke.
void smoke_age(const Solver& solver, std::span<float> out);

/// Wind [nz][ny][nx][3] east, north, up, m/s; wind along a slope has an upward part.
void velocity(const Solver& solver, std::span<float> out);

/// Temperature excess over the ambient air at the same height, K, with latent heat of cloud water.
void temperature_excess(const Solver& solver, std::span<float> out);

/// Cloud water mixing ratio, kg/kg.
void cloud(const Solver& solver, std::span<float> out);

/// Elevation of cell centres, m.
void heights(const Solver& solver, std::span<float> out);

} // namespace firetwin::flow
