#pragma once

#include "base/vector.hpp"
#include "geo/height_field.hpp"

namespace firetwin::lod {

/// Whether the ground hides all of a ball from a camera.
///
/// A straight line from the camera to any point of the ball runs, at the fraction t of its way,
/// within t radius of the line to the centre. So the ball is hidden if for some t the ground is
/// higher than the centre's line + t radius everywhere within t radius of it. The ground's lowest
/// nodes stand for it and t is sampled at most half a cell apart (and half a ball, further out):
/// what is called hidden is hidden, while a ball that only just hides may count as seen. A camera
/// in the ground sees everything, and what lies outside the grid hides nothing.
bool hidden(const Vector& camera, const Vector& centre, double radius,
            const geo::HeightField& ground);

} // namespace firetwin::lod
