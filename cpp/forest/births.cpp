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

std::size_t Births::Octave::keys(std::uint64_t line, std::int64_t column,
                                 std::span<std::uint64_t, most> out) const {
  // Chance of at most 0, 1, .. births where there is one on average; more than 7 come once in
  // 100,000 squares and are left out.
  constexpr std::array<double, most> at_most = {0.367879441, 0.735758882, 0.919698603, 0.981011843,
                                                0.996340153, 0.999405815, 0.999916759};
  const std::uint64_t key = mix(line ^ static_cast<std::uint64_t>(column));
  const double chance = unit(key);
  std::size_t count = 0;
  for (std::size_t i = 0; i < most; ++i) {
    out[i] = key + i;
    count += chance >= at_most[i];
  }
  return count;
}

Births::Birth Births::Octave::birth(double column, double row, std::uint64_t key) const {
  const std::uint64_t bits = mix(key);
  return {(column + part(bits >> 43)) * side, (row + part(bits >> 22)) * side,
          begin + (end - begin) * part(bits >> 1), bits};
}

/// Nothing here branches on what is random: more is written than counts, and written over.
void Births::Squares::add(const Octave& octave, std::int64_t at_row, double before, Row& work) {
  const auto width = static_cast<std::size_t>(columns);
  const std::uint64_t line = octave.line(at_row);
  std::size_t births = 0;
  work.resize((width + 1) * most);
  for (std::size_t i = 0; i < width; ++i) {
    const std::int64_t at = column + static_cast<std::int64_t>(i);
    std::fill_n(&work.column[births], most, static_cast<double>(at));
    work.begin[i] = births;
    births += octave.keys(line, at, std::span<std::uint64_t, most>(&work.key[births], most));
  }
  if (x.size() < size + births + 1) {
    resize(2 * (size + births + 1));
  }
  for (std::size_t i = 0; i < births; ++i) {
    const Birth b = octave.birth(work.column[i], static_cast<double>(at_row), work.key[i]);
    x[size] = b.x;
    y[size] = b.y;
    time[size] = b.time;
    bits[size] = b.bits;
    work.place[i] = static_cast<std::uint32_t>(size);
    size += b.time < before;
  }
  work.place[births] = static_cast<std::uint32_t>(size);
  for (std::size_t i = 0; i < width; ++i) {
    first.push_back(work.place[work.begin[i]]);
  }
}

void Births::Row::resize(std::size_t births) {
  if (key.size() < births) {
    key.resize(births);
    column.resize(births);
    place.resize(births);
    begin.resize(births);
  }
}

void Births::Squares::resize(std::size_t births) {
  x.resize(births);
  y.resize(births);
  time.resize(births);
  bits.resize(births);
}

void Births::gather(const Area& area, double margin, double before) {
  for (std::size_t k = 0; k < octaves; ++k) {
    const Octave& octave = octaves_[k];
    Squares& known = known_[k];
    known.first.clear();
    known.size = 0;
    known.column = octave.number(area.left - margin);
    known.row = octave.number(area.low - margin);
    known.columns = octave.number(area.right + margin) - known.column + 1;
    known.rows = octave.begin < before ? octave.number(area.high + margin) - known.row + 1 : 0;
    for (auto row = known.row; row < known.row + known.rows; ++row) {
      known.add(octave, row, before, row_);
    }
    known.first.push_back(static_cast<std::uint32_t>(known.size));
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
          std::array<std::uint64_t, most> keys;
          const std::size_t count = octave.keys(octave.line(row), column, keys);
          for (std::size_t i = 0; i < count; ++i) {
            const Birth b =
                octave.birth(static_cast<double>(column), static_cast<double>(row), keys[i]);
            crowded |= crowds(b.x, b.y, b.time);
          }
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
