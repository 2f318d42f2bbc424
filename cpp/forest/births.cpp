#include "forest/births.hpp"

#include <algorithm>
#include <numbers>

namespace firetwin::forest {
namespace {

/// 21 bits as a number in [0, 1), by way of what processors convert at once.
double part(std::uint64_t bits) {
  return static_cast<double>(static_cast<std::int32_t>(bits & 0x1FFFFF)) * 0x1p-21;
}

} // namespace

Births::Births(std::uint64_t seed) {
  for (std::size_t k = 0; k < octaves; ++k) {
    Octave& octave = octaves_[k];
    octave.seed = mix(mix(seed), k);
    octave.end = std::ldexp(latest, -2 * static_cast<int>(k));
    octave.begin = k + 1 == octaves ? 0.0 : 0.25 * octave.end;
    octave.side = 1.0 / std::sqrt(octave.end - octave.begin);
    octave.per_metre = 1.0 / octave.side;
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

template <class Visit>
void Births::Octave::births(std::int64_t column, std::int64_t row, const Visit& visit) const {
  // Chance of at most 0, 1, .. births where there is one on average; more than 7 come once in
  // 100,000 squares and are left out.
  constexpr std::array<double, most> at_most = {0.367879441, 0.735758882, 0.919698603, 0.981011843,
                                                0.996340153, 0.999405815, 0.999916759};
  const std::uint64_t line = mix(seed, static_cast<std::uint64_t>(row));
  const std::uint64_t key = mix(line ^ static_cast<std::uint64_t>(column));
  const double chance = unit(key);
  std::uint64_t count = 0;
  for (const double each : at_most) {
    count += chance >= each;
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t bits = mix(key + i);
    visit(Birth{(static_cast<double>(column) + part(bits >> 43)) * side,
                (static_cast<double>(row) + part(bits >> 22)) * side,
                begin + (end - begin) * part(bits >> 1), bits});
  }
}

void Births::Squares::clear() {
  column = row = columns = rows = 0;
  first.clear();
  x.clear();
  y.clear();
  time.clear();
  bits.clear();
}

void Births::gather(const Area& area, double margin, double time) {
  for (std::size_t k = 0; k < octaves; ++k) {
    const Octave& octave = octaves_[k];
    Squares& known = known_[k];
    known.clear();
    if (octave.begin >= time) {
      continue;
    }
    known.column = octave.number(area.left - margin);
    known.row = octave.number(area.low - margin);
    known.columns = octave.number(area.right + margin) - known.column + 1;
    known.rows = octave.number(area.high + margin) - known.row + 1;
    for (auto row = known.row; row < known.row + known.rows; ++row) {
      for (auto column = known.column; column < known.column + known.columns; ++column) {
        known.first.push_back(static_cast<std::uint32_t>(known.x.size()));
        octave.births(column, row, [&](const Birth& b) {
          if (b.time < time) {
            known.x.push_back(b.x);
            known.y.push_back(b.y);
            known.time.push_back(b.time);
            known.bits.push_back(b.bits);
          }
        });
      }
    }
    known.first.push_back(static_cast<std::uint32_t>(known.x.size()));
  }
}

bool Births::stands(const Birth& birth, double reach) const {
  const double square = reach / std::numbers::pi, radius = std::sqrt(square);
  const auto crowds = [&](double x, double y, double time) {
    const double dx = x - birth.x, dy = y - birth.y;
    return (time < birth.time) & (dx * dx + dy * dy < square);
  };
  for (std::size_t k = 0; k < octaves; ++k) {
    const Octave& octave = octaves_[k];
    if (octave.begin >= birth.time) {
      continue;
    }
    const Squares& known = known_[k];
    const std::int64_t left = octave.number(birth.x - radius),
                       right = octave.number(birth.x + radius),
                       low = octave.number(birth.y - radius),
                       high = octave.number(birth.y + radius);
    bool crowded = false;
    if (known.hold(left, right, low, high)) {
      for (auto row = low; row <= high && !crowded; ++row) {
        const std::size_t end = known.end(row, right);
        for (std::size_t i = known.begin(row, left); i < end; ++i) {
          crowded |= crowds(known.x[i], known.y[i], known.time[i]);
        }
      }
    } else { // it reaches farther than the margin
      for (auto row = low; row <= high; ++row) {
        for (auto column = left; column <= right; ++column) {
          octave.births(column, row, [&](const Birth& b) { crowded |= crowds(b.x, b.y, b.time); });
        }
      }
    }
    if (crowded) {
      return false;
    }
  }
  return true;
}

} // namespace firetwin::forest
