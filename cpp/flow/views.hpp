#pragma once

#include "flow/solver.hpp"

#include <span>

/// A flow's fields in cells' middles, [nz][ny][nx], in units that pictures use.
namespace firetwin::flow {

/// kg per m3 of the true air: layers are thinner over high ground.
void smoke_density(const Solver& solver, std::span<float> out);

/// Mean time since the smoke was given off, s; 0 where there is none.
void smoke_age(const Solver& solver, std::span<float> out);

/// [nz][ny][nx][3] east, north, up, m/s; up is true: a wind along the ground climbs it.
void velocity(const Solver& solver, std::span<float> out);

/// Of air above the ambient's at its height, K; with the latent heat of its cloud.
void warmth(const Solver& solver, std::span<float> out);

/// kg per kg of air.
void cloud(const Solver& solver, std::span<float> out);

/// Height of cells' middles, m.
void heights(const Solver& solver, std::span<float> out);

} // namespace firetwin::flow
