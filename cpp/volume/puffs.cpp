#include "volume/puffs.hpp"

#include "base/check.hpp"
#include "base/random.hpp"
#include "base/smoothstep.hpp"
#include "base/vector.hpp"
#include "volume/emission.hpp"
#include "volume/plume.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace firetwin::volume {
namespace {

constexpr double entrainment = 0.3;
constexpr double turbulent_growth = 0.02;
constexpr double fire_flux = 1.0e5;       // W/m2
constexpr double faint_density = 2.0e-8;  // kg/m3; thinner smoke gets no surface balls
constexpr std::uint64_t stem_keys = 1000; // offset from the keys of surface balls
constexpr int child_count = 16;
constexpr int grandchild_count = 9;

struct Ball {
  Vector position;
  double radius;
  double density;
  double age;
  double mass;
  std::uint64_t identity;
};

/// Limits the number of intervals: each costs time, and is identified by an integer.
void check_intervals(double time, const PuffSettings& settings) {
  constexpr double most = 1e4, last = 1e15;
  if (settings.max_age / settings.interval > most || std::abs(time) / settings.interval > last) {
    throw std::invalid_argument("interval is too short: max_age may last 10,000 intervals at most");
  }
}

void check(double time, const Burn& burn, const PuffSettings& settings) {
  check_finite(time, "time");
  check_finite(burn.arrival, "arrival (leave out cells that do not burn)");
  check_finite(burn.fuel, "fuel");
  check_finite(burn.position, "position");
  check_finite(burn.wind, "wind");
  check_above_zero(burn.cell_area, "cell_area");
  check_above_zero(settings.interval, "interval");
  check_above_zero(settings.max_age, "max_age");
  check_intervals(time, settings);
  check_above_zero(settings.burn_time, "burn_time");
  check_above_zero(settings.stability, "stability");
  check_above_zero(settings.block, "block");
  check_above_zero(settings.merge_radius, "merge_radius");
  check_above_zero(settings.smallest, "smallest");
  check_above_zero(settings.smoke_fraction, "smoke_fraction");
  check_above_zero(settings.heat_of_combustion, "heat_of_combustion");
  check_finite(settings.turbulence, "turbulence");
}

/// Returns point `index` of a Fibonacci lattice on the unit sphere, rotated and jittered by `key`.
Vector direction(int index, int count, std::uint64_t key) {
  const double shake = uniform(key, static_cast<std::uint64_t>(index) + 1) - 0.5;
  const double up = std::clamp(1.0 - (2.0 * index + 1.0 + shake) / count, -1.0, 1.0);
  const double turn =
      2.0 * std::numbers::pi * (uniform(key, 0) + index * (std::numbers::phi - 1.0));
  const double across = std::sqrt(1.0 - up * up);
  return {across * std::cos(turn), across * std::sin(turn), up};
}

/// Adds balls on the surface of `parent`: sixteen, then nine on each of these.
void add_surface(std::vector<Ball>& balls, const Ball& parent, double smallest, int generation) {
  const int count = generation == 1 ? child_count : grandchild_count;
  const double least = generation == 1 ? 0.28 : 0.3;
  if (parent.radius * 0.5 <= smallest || parent.density < faint_density) {
    return;
  }
  for (int i = 0; i < count; ++i) {
    const std::uint64_t key = mix(parent.identity, static_cast<std::uint64_t>(i) + 1);
    double radius = parent.radius * (least + (0.5 - least) * uniform(key, 0));
    if (radius <= smallest) {
      continue;
    }
    // No ball appears or disappears at full size.
    radius *= smoothstep(1.0, 1.5, radius / smallest) *
              smoothstep(1.0, 2.0, parent.density / faint_density);
    const Vector way = direction(i, count, parent.identity);
    Ball child = parent;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      child.position[axis] += way[axis] * (parent.radius - 0.15 * radius);
    }
    child.radius = radius;
    child.mass = 0.0;
    child.identity = key;
    balls.push_back(child);
    if (generation == 1) {
      add_surface(balls, child, smallest, 2);
    }
  }
}

/// Tracks smoke from its sources to `time_`.
class Follower {
public:
  Follower(double time, const PuffSettings& settings) : time_(time), settings_(settings) {}

  void follow(const Source& source, std::vector<Ball>& balls) const {
    const double age = time_ - source.start;
    const double grown = smoothstep(1.5, 3.0, age / settings_.interval);
    const double fade = 1.0 - smoothstep(0.5, 1.0, age / settings_.max_age);
    if (grown < 1.0) {
      const double step = settings_.interval / stem_count;
      for (std::size_t i = 0; i < stem_count; ++i) {
        const double stem_age = age - static_cast<double>(i) * step;
        if (stem_age > 0.0) {
          const double size = std::cbrt(1.0 - grown) * smoothstep(0.0, 3.0 * step, stem_age);
          add(balls, source, mix(source.key, stem_keys + i), stem_age, size,
              source.stems[i] * (1.0 - grown) * fade);
        }
      }
    }
    if (grown > 0.0) {
      add(balls, source, source.key, age, std::cbrt(grown), source.burned * grown * fade);
    }
  }

private:
  void add(std::vector<Ball>& balls, const Source& source, std::uint64_t key, double age,
           double size, double fuel) const {
    const double speed = std::hypot(source.wind[0], source.wind[1]);
    const double vigour = 1.0 + settings_.turbulence * (0.2 * (uniform(key, 1) - 0.5) +
                                                        0.3 * (uniform(source.gust, 0) - 0.5));
    const Plume plume(source.merged_power * vigour * vigour * vigour, speed, settings_.stability);
    const double rise = plume.rise(age);
    const double drift = plume.drift(age);
    const double fire = std::sqrt(source.power / (std::numbers::pi * fire_flux));
    const double full = fire + entrainment * rise + turbulent_growth * drift;
    const double sway = settings_.turbulence * full;
    const double turn = 2.0 * std::numbers::pi * uniform(key, 2);
    const double sideways = 0.55 * sway * std::sqrt(uniform(key, 3));
    Ball ball{source.position, full * size, 0.0, age, fuel * settings_.smoke_fraction, key};
    for (std::size_t axis = 0; axis < 2 && speed > 0.0; ++axis) {
      ball.position[axis] += source.wind[axis] / speed * drift;
    }
    ball.position[0] += sideways * std::cos(turn);
    ball.position[1] += sideways * std::sin(turn);
    ball.position[2] += 0.8 * fire + rise + 0.5 * sway * (uniform(key, 4) - 0.5);
    if (ball.radius <= 0.0) {
      ball.radius = 0.0;
    } else {
      ball.density = ball.mass / (4.0 / 3.0 * std::numbers::pi * std::pow(ball.radius, 3));
    }
    balls.push_back(ball);
    add_surface(balls, ball, settings_.smallest, 1);
  }

  double time_;
  const PuffSettings& settings_;
};

} // namespace

Puffs puffs(double time, const Burn& burn, const PuffSettings& settings) {
  check(time, burn, settings);
  const Emission emission = gather(time, burn, settings);
  const Follower follower(time, settings);
  std::vector<std::vector<Ball>> parts(emission.sources.size());
  tbb::parallel_for(std::size_t{0}, parts.size(),
                    [&](std::size_t i) { follower.follow(emission.sources[i], parts[i]); });

  Puffs result;
  result.emitted = emission.burned * settings.smoke_fraction;
  result.left = emission.forgotten * settings.smoke_fraction;
  result.heat_per_smoke = settings.heat_of_combustion / settings.smoke_fraction;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    double shown = 0.0;
    for (const Ball& ball : parts[i]) {
      for (const double coordinate : ball.position) {
        result.position.push_back(static_cast<float>(coordinate));
      }
      result.radius.push_back(static_cast<float>(ball.radius));
      result.density.push_back(static_cast<float>(ball.density));
      result.age.push_back(static_cast<float>(ball.age));
      result.mass.push_back(ball.mass);
      result.identity.push_back(ball.identity);
      shown += ball.mass;
    }
    result.left += emission.sources[i].burned * settings.smoke_fraction - shown;
  }
  return result;
}

} // namespace firetwin::volume
