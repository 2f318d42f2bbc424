#include "particles/advance.hpp"

#include "base/check.hpp"
#include "particles/ground_contact.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>

namespace firetwin::particles {
namespace {

Vector vector_at(std::span<const double> values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

Motion motion_of(const Particles& p, const Forces& f, std::size_t i, double step) {
  Motion m{};
  m.position = vector_at(p.position, i);
  m.velocity = vector_at(p.velocity, i);
  m.wind = vector_at(f.wind, i);
  m.lift = f.lift[i];
  m.relaxation = f.relaxation[i];
  const Vector middle = vector_at(f.wind_middle, i);
  const Vector end = vector_at(f.wind_end, i);
  for (std::size_t k = 0; k < 3; ++k) {
    const double first = middle[k] - m.wind[k], second = end[k] - middle[k];
    m.gust[k] = (3.0 * first - second) / step;
    m.bend[k] = 4.0 * (second - first) / (step * step);
  }
  return m;
}

void move(const Particles& p, Motion motion, std::size_t i, double step,
          const geo::HeightField* ground) {
  std::optional<double> end;
  if (ground) {
    motion.position = raised_to_ground(motion.position, *ground);
    end = ground_contact(motion, step, step, *ground);
  }
  Motion::State state = motion.at(end.value_or(step));
  if (end) {
    p.landed[i] = 1;
    state.velocity = {};
    state.position[2] = ground->at(state.position[0], state.position[1]);
  }
  std::copy_n(state.position.begin(), 3, &p.position[3 * i]);
  std::copy_n(state.velocity.begin(), 3, &p.velocity[3 * i]);
}

} // namespace

void advance(const Particles& particles, const Forces& forces, double step,
             const geo::HeightField* ground) {
  check_zero_or_more(step, "step");
  if (!std::all_of(forces.relaxation.begin(), forces.relaxation.end(),
                   [](double tau) { return tau >= 0.0; })) {
    throw std::invalid_argument("relaxation must be 0 or more");
  }
  if (step == 0.0) {
    return;
  }
  using Range = tbb::blocked_range<std::size_t>;
  tbb::parallel_for(Range(0, particles.landed.size(), 256), [&](const Range& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      if (!particles.landed[i]) {
        move(particles, motion_of(particles, forces, i, step), i, step, ground);
      }
    }
  });
}

} // namespace firetwin::particles
