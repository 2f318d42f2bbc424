#include "particles/particle_cloud.hpp"

#include "base/check.hpp"
#include "base/random.hpp"
#include "particles/ground_contact.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

namespace firetwin::particles {
namespace {

constexpr double max_particles = 1e8;

/// Second word of the Philox key; 0 is used by the forest.
constexpr std::uint64_t stream = 1;

void check_range(const Range& range, const std::string& name, double least) {
  if (!(range[0] >= least && range[0] <= range[1]) || !std::isfinite(range[1])) {
    throw std::invalid_argument(name + " must be two ascending finite numbers, " +
                                (least >= 0.0 ? "0 or more" : "low and high"));
  }
}

void check(double time, const Sources& sources, const ParticleKind& kind, const Wind& wind) {
  check_range(kind.relaxation, "relaxation", 0.0);
  check_range(kind.rise, "rise", -1e9);
  check_range(kind.spread, "spread", 0.0);
  check_range(kind.life, "life", 0.0);
  check_finite(time, "time");
  check_finite(kind.lift, "lift");
  check_zero_or_more(sources.size, "size");
  const auto finite = [](double v) { return std::isfinite(v); };
  check_finite(wind.time, "wind_time");
  if (wind.time.empty() || std::adjacent_find(wind.time.begin(), wind.time.end(),
                                              std::greater_equal<>()) != wind.time.end()) {
    throw std::invalid_argument("wind needs at least one time; times must be finite and ascending");
  }
  double expected = 0.0;
  for (std::size_t i = 0; i < sources.rate.size(); ++i) {
    if (!(sources.rate[i] >= 0.0) || !finite(sources.rate[i]) || !finite(sources.start[i]) ||
        !finite(sources.end[i])) {
      throw std::invalid_argument("rate, start and end must be finite, and rate must be 0 or more");
    }
    expected += sources.rate[i] * kind.life[1];
  }
  if (expected > max_particles) {
    throw std::invalid_argument("rate and life give " + std::to_string(expected) +
                                " particles; the limit is 1e8");
  }
}

double within(const Range& range, std::uint64_t bits) {
  return range[0] + unit(bits) * (range[1] - range[0]);
}

/// The wind of one source.
class SourceWind {
public:
  SourceWind(const Wind& wind, std::size_t source, std::size_t sources)
      : time_(wind.time), velocity_(wind.velocity) {
    const bool shared = velocity_.size() == 3 * time_.size();
    stride_ = shared ? 3 : 3 * sources;
    offset_ = shared ? 0 : 3 * source;
  }

  /// Sets wind and gust of a motion that starts at `time`. Returns the time of their next change.
  double set(Motion& motion, double time) const {
    const auto next = static_cast<std::size_t>(std::upper_bound(time_.begin(), time_.end(), time) -
                                               time_.begin());
    const std::size_t before = next > 0 ? next - 1 : 0;
    const std::size_t after = std::min(next, time_.size() - 1);
    const double span = after > before ? time_[after] - time_[before] : 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double u = velocity_[before * stride_ + offset_ + i];
      motion.gust[i] = (velocity_[after * stride_ + offset_ + i] - u) / span;
      motion.wind[i] = after > before ? u + motion.gust[i] * (time - time_[before]) : u;
    }
    return next < time_.size() ? time_[next] : std::numeric_limits<double>::infinity();
  }

private:
  std::span<const double> time_;
  std::span<const double> velocity_;
  std::size_t stride_;
  std::size_t offset_;
};

struct Launch {
  double time;
  double life;
  Motion motion;
};

Launch launch(const Sources& sources, const ParticleKind& kind, std::size_t source,
              std::uint64_t number, std::uint64_t seed) {
  const auto a = philox({sources.id[source], number, 0, 0}, {seed, stream});
  const auto b = philox({sources.id[source], number, 1, 0}, {seed, stream});
  const double turn = 2.0 * std::numbers::pi * unit(b[0]);
  const double spread = within(kind.spread, b[1]);
  const double* place = &sources.position[3 * source];
  Launch l{};
  l.time =
      sources.start[source] + (static_cast<double>(number) + unit(a[0])) / sources.rate[source];
  l.life = within(kind.life, a[1]);
  l.motion.position = {place[0] + sources.size * (unit(b[2]) - 0.5),
                       place[1] + sources.size * (unit(b[3]) - 0.5), place[2]};
  l.motion.velocity = {spread * std::cos(turn), spread * std::sin(turn), within(kind.rise, a[3])};
  l.motion.relaxation = within(kind.relaxation, a[2]);
  l.motion.lift = kind.lift;
  return l;
}

struct Now {
  Motion::State state;
  bool landed;
};

/// State of a particle at `time`. Its path is split at wind changes and at the end of its life,
/// never at `time`, so that its landing time does not depend on `time`.
Now follow(Launch l, double time, const SourceWind& wind, const geo::HeightField* ground) {
  if (ground) {
    l.motion.position = raised_to_ground(l.motion.position, *ground);
  }
  const double gone = l.time + l.life;
  for (double begin = l.time;;) {
    const double end = std::min(wind.set(l.motion, begin), gone);
    if (const auto contact =
            ground ? ground_contact(l.motion, end - begin, time - begin, *ground) : std::nullopt) {
      Vector place = l.motion.at(*contact).position;
      place[2] = ground->at(place[0], place[1]);
      return {{place, {}}, true};
    }
    if (time <= end || end >= gone) {
      Motion::State state = l.motion.at(time - begin);
      state.position = ground ? raised_to_ground(state.position, *ground) : state.position;
      return {state, false};
    }
    const Motion::State state = l.motion.at(end - begin);
    l.motion.position = state.position;
    l.motion.velocity = state.velocity;
    begin = end;
  }
}

void add(ParticleCloud& cloud, std::size_t source, std::uint64_t number, const Launch& l,
         double time, const Now& now) {
  cloud.source.push_back(static_cast<std::int64_t>(source));
  cloud.number.push_back(static_cast<std::int64_t>(number));
  cloud.position.insert(cloud.position.end(), now.state.position.begin(), now.state.position.end());
  cloud.velocity.insert(cloud.velocity.end(), now.state.velocity.begin(), now.state.velocity.end());
  cloud.age.push_back(time - l.time);
  cloud.life.push_back(l.life);
  cloud.landed.push_back(now.landed);
}

template <class T> void append(std::vector<T>& all, const std::vector<T>& part) {
  all.insert(all.end(), part.begin(), part.end());
}

} // namespace

ParticleCloud state(double time, const Sources& sources, const ParticleKind& kind, const Wind& wind,
                    const geo::HeightField* ground, std::uint64_t seed) {
  check(time, sources, kind, wind);
  const std::size_t m = sources.rate.size();
  std::vector<ParticleCloud> parts(m);
  tbb::parallel_for(std::size_t{0}, m, [&](std::size_t s) {
    const double rate = sources.rate[s], since = time - sources.start[s];
    // Number k starts within (k .. k + 1) / rate after the start.
    const double first = std::max(0.0, std::floor((since - kind.life[1]) * rate) - 1.0);
    const double last = std::min(since, sources.end[s] - sources.start[s]) * rate;
    const SourceWind here(wind, s, m);
    for (double k = first; k <= last && rate > 0.0; ++k) {
      const auto number = static_cast<std::uint64_t>(k);
      const Launch l = launch(sources, kind, s, number, seed);
      if (l.time <= time && l.time < sources.end[s] && time < l.time + l.life) {
        add(parts[s], s, number, l, time, follow(l, time, here, ground));
      }
    }
  });
  ParticleCloud all;
  for (const ParticleCloud& part : parts) {
    append(all.source, part.source);
    append(all.number, part.number);
    append(all.position, part.position);
    append(all.velocity, part.velocity);
    append(all.age, part.age);
    append(all.life, part.life);
    append(all.landed, part.landed);
  }
  return all;
}

} // namespace firetwin::particles
