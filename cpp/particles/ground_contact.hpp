#pragma once

#include "geo/height_field.hpp"
#include "particles/motion.hpp"

#include <optional>

namespace firetwin::particles {

/// When a motion of `duration` seconds first meets the ground, if that is not after `until`.
///
/// The path is looked at in equal parts of `duration`, short enough that it crosses half a cell of
/// the ground in each at most (10,000 parts at most), and the first part that ends below the ground
/// is bisected. So the answer does not depend on `until`, and a hill that the path cuts off within
/// one part does not stop it.
std::optional<double> ground_contact(const Motion& motion, double duration, double until,
                                     const geo::HeightField& ground);

/// The same place, not below the ground.
Vector raised_to_ground(const Vector& position, const geo::HeightField& ground);

} // namespace firetwin::particles
