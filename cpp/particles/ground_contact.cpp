#include "particles/ground_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace firetwin::particles {
namespace {

constexpr double max_step = 1.0; // s
constexpr double max_steps = 10'000.0;

bool below(const Vector& position, const geo::HeightField& ground) {
  return position[2] < ground.highest() && position[2] < ground.at(position[0], position[1]);
}

/// Estimate of the highest horizontal speed (exact for wind without curvature): drag pulls the
/// velocity towards the wind.
double fastest(const Motion& motion, double duration) {
  double speed = std::hypot(motion.velocity[0], motion.velocity[1]);
  for (const double t : {0.0, 0.5 * duration, duration}) {
    std::array<double, 2> wind{};
    for (std::size_t i = 0; i < 2; ++i) {
      wind[i] = motion.wind[i] + t * (motion.gust[i] + 0.5 * t * motion.bend[i]);
    }
    speed = std::max(speed, std::hypot(wind[0], wind[1]));
  }
  return speed;
}

/// Last time in low..high at which the particle is not below the ground, to double precision.
double bisect(const Motion& motion, double low, double high, const geo::HeightField& ground) {
  for (double middle = 0.5 * (low + high); middle > low && middle < high;
       middle = 0.5 * (low + high)) {
    (below(motion.at(middle).position, ground) ? high : low) = middle;
  }
  return low;
}

} // namespace

std::optional<double> ground_contact(const Motion& motion, double duration, double until,
                                     const geo::HeightField& ground) {
  const double part = std::min(max_step, 0.5 * ground.smallest_cell() / fastest(motion, duration));
  const double parts = std::clamp(std::ceil(duration / part), 1.0, max_steps);
  double before = 0.0;
  for (double i = 1.0; i <= parts && before < until; ++i) {
    const double now = duration * (i / parts);
    if (below(motion.at(now).position, ground)) {
      const double time = bisect(motion, before, now, ground);
      return time <= until ? std::optional(time) : std::nullopt;
    }
    before = now;
  }
  return std::nullopt;
}

Vector raised_to_ground(const Vector& position, const geo::HeightField& ground) {
  Vector p = position;
  if (below(p, ground)) {
    p[2] = ground.at(p[0], p[1]);
  }
  return p;
}

} // namespace firetwin::particles
