#include "forest/births.hpp"

#include <algorithm>
#include <numbers>

namespace firetwin::forest {

Births::Births(std::uint64_t seed) : known_(std::size_t{octaves} * remembered * remembered) {
  for (std::size_t k = 0; k < octaves; ++k) {
    seed_[k] = mix(mix(seed), k);
    end_[k] = std::ldexp(latest, -2 * static_cast<int>(k));
    begin_[k] = k + 1 == octaves ? 0.0 : 0.25 * end_[k];
    side_[k] = 1.0 / std::sqrt(end_[k] - begin_[k]);
    per_metre_[k] = 1.0 / side_[k];
  }
}

double Births::reach(double density) {
  const auto solve = [](double chance) { // part = 1 - exp(-chance part)
    double part = 1.0;
    for (int i = 0; i < 5; ++i) {
      part = -std::expm1(-chance * part);
    }
    return part;
  };
  static const double sparse = solve(last_chance);
  return (latest >= last_chance * density ? sparse : solve(latest / density)) / density;
}

double Births::older(double time, double density) {
  const double area = reach(density);
  return std::expm1(-time * area) / std::expm1(-std::min(latest, last_chance * density) * area);
}

void Births::fill(Square& square, int octave) const {
  // Chance of at most 0, 1, .. births where there is one on average; more than 7 come once in
  // 100,000 squares and are left out.
  constexpr std::array<double, most> at_most = {0.367879441, 0.735758882, 0.919698603, 0.981011843,
                                                0.996340153, 0.999405815, 0.999916759};
  const std::uint64_t row =
      mix(seed_[static_cast<std::size_t>(octave)], static_cast<std::uint64_t>(square.row));
  const std::uint64_t key = mix(row ^ static_cast<std::uint64_t>(square.column));
  const double chance = unit(key);
  square.count = 0;
  for (const double each : at_most) {
    square.count += chance >= each;
  }
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(square.count); ++i) {
    square.bits[i] = mix(key + i);
  }
}

bool Births::stands(const Birth& birth, double reach) {
  const double square = reach / std::numbers::pi, radius = std::sqrt(square);
  for (int octave = 0; octave < octaves; ++octave) {
    const auto k = static_cast<std::size_t>(octave);
    if (begin_[k] >= birth.time) {
      continue;
    }
    const auto right = number(birth.x + radius, k);
    const auto high = number(birth.y + radius, k);
    for (auto row = number(birth.y - radius, k); row <= high; ++row) {
      for (auto column = number(birth.x - radius, k); column <= right; ++column) {
        const Square& others = at(octave, column, row);
        for (int i = 0; i < others.count; ++i) {
          const Birth other = this->birth(octave, others, i);
          const double dx = other.x - birth.x, dy = other.y - birth.y;
          if ((other.time < birth.time) & (dx * dx + dy * dy < square)) {
            return false;
          }
        }
      }
    }
  }
  return true;
}

} // namespace firetwin::forest
