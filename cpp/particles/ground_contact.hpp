#pragma once

#include "geo/height_field.hpp"
#include "particles/motion.hpp"

#include <optional>

namespace firetwin::particles {

/// Time of the first ground contact of a motion of `duration` seconds; empty if it is after
/// `until`.
///
/// The path is sampled at equal steps of `duration`, short enough to cross at most half a ground
/// cell each (at most 10,000 steps); the first step that ends below the ground is bisected. So the
/// result does not depend on `until`, and a hill that the path crosses within one step is missed.
std::optional<double> ground_contact(const Motion& motion, double duration, double until,
                                     const geo::HeightField& ground);

/// Clamps a position to the ground from below.
Vector raised_to_ground(const Vector& position, const geo::HeightField& ground);

} // namespace firetwin::particles
