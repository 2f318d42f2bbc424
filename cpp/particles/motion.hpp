#pragma once

#include "base/vector.hpp"

namespace firetwin::particles {

/// Weight less buoyancy, m/s2 upwards: g (air / density - 1), after Archimedes. Embers sink, flame
/// gas rises.
double lift(double density, double air_density);

/// Motion of one particle in a wind that is a parabola in time:
///   dv/dt = (u(t) - v) / tau + a,  u(t) = u0 + w t + q t^2 / 2
/// (drag linear in the slip, gravity and buoyancy: the leading terms of Maxey & Riley 1983,
/// doi:10.1063/1.864230). Solved exactly, by variation of constants: with s = t / tau,
///   v = v0 phi0 + u0 (1 - phi0) + t (a phi1 + w (1 - phi1)) + t^2 q (1/2 - phi2),
///   x = x0 + t (v0 phi1 + u0 (1 - phi1)) + t^2 (a phi2 + w (1/2 - phi2)) + t^3 q (1/6 - phi3),
/// with phi0 = e^-s, phi1 = (1 - phi0) / s, phi2 = (1 - phi1) / s, phi3 = (1/2 - phi2) / s.
/// It holds for any t >= 0 and any tau from 0 (passive tracer) to infinity (free fall), and is
/// stable for any step.
struct Motion {
  Vector position;   ///< at t = 0, m
  Vector velocity;   ///< at t = 0, m/s
  Vector wind;       ///< u0, m/s
  Vector gust;       ///< w, m/s2
  Vector bend;       ///< q, m/s3
  double lift;       ///< a, upwards, m/s2
  double relaxation; ///< tau, s

  struct State {
    Vector position;
    Vector velocity;
  };
  State at(double t) const;
};

} // namespace firetwin::particles
