#include "forest/births.hpp"

#include "base/clones.hpp"

#include <algorithm>
#include <numbers>

namespace firetwin::forest {
namespace {

constexpr std::size_t at_once = 4; ///< births

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

namespace {

/// Of births in a reach, `chance` on average, the part that may be there: 1 - exp(-chance part).
double solve(double chance) {
  double part = 1.0;
  for (int i = 0; i < 5; ++i) {
    part = -std::expm1(-chance * part);
  }
  return part;
}

/// The same where `last_chance` ends births, not their `latest`.
const double sparse = solve(Births::last_chance),
             sparse_end = std::expm1(-Births::last_chance * sparse);

bool is_sparse(double density) {
  return Births::latest >= Births::last_chance * density;
}

} // namespace

double Births::reach(double density) {
  return (is_sparse(density) ? sparse : solve(latest / density)) / density;
}

double Births::older(double time, double density) {
  const double area = reach(density);
  return std::expm1(-time * area) / (is_sparse(density) ? sparse_end : std::expm1(-latest * area));
}

std::size_t Births::Octave::keys(std::uint64_t line, std::int64_t column,
                                 std::span<std::uint64_t, most> out) const {
  // Chance of at most 0, 1, .. births where there is one on average; more than 7 come once in
  // 100,000 squares and are left out. Eight numbers are compared as quickly as seven.
  constexpr std::array<double, most + 1> at_most = {0.367879441, 0.735758882, 0.919698603,
                                                    0.981011843, 0.996340153, 0.999405815,
                                                    0.999916759, 1.0};
  const std::uint64_t key = mix(line ^ static_cast<std::uint64_t>(column));
  const double chance = unit(key);
  std::int64_t count = 0;
  for (std::size_t i = 0; i <= most; ++i) {
    count += chance >= at_most[i];
  }
  for (std::size_t i = 0; i < most; ++i) {
    out[i] = key + i;
  }
  return static_cast<std::size_t>(count);
}

Births::Birth Births::Octave::birth(double column, double row, std::uint64_t key) const {
  Birth one{};
  births(row, 1, &column, &key, &one.x, &one.y, &one.time, &one.bits);
  return one;
}

FIRETWIN_CLONES("avx512f", "avx2")
void Births::Octave::births(double row, std::size_t n, const double* column,
                            const std::uint64_t* key, double* x, double* y, double* time,
                            std::uint64_t* bits) const {
  const double across = side, first = begin, more = end - begin;
#pragma GCC ivdep
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint64_t found = mix(key[i]);
    bits[i] = found;
    x[i] = (column[i] + part(found >> 43)) * across;
    y[i] = (row + part(found >> 22)) * across;
    time[i] = first + more * part(found >> 1);
  }
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
  const std::size_t begin = size;
  octave.births(static_cast<double>(at_row), births, work.column.data(), work.key.data(), &x[begin],
                &y[begin], &time[begin], &bits[begin]);
  for (std::size_t i = begin; i < begin + births; ++i) {
    const double when = time[i];
    x[size] = x[i];
    y[size] = y[i];
    time[size] = when;
    bits[size] = bits[i];
    work.place[i - begin] = static_cast<std::uint32_t>(size);
    size += when < before;
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

void Births::Many::resize(std::size_t births) {
  x.resize(births);
  y.resize(births);
  time.resize(births);
  bits.resize(births);
}

void Births::gather(const Area& area, double before) {
  // Where next to nothing stands reaches have no end; then what is farther is asked one by one.
  const double radius =
      std::min(std::sqrt(reach(std::min(before / last_chance, most_stems)) / std::numbers::pi),
               4.0 * octaves_.back().side);
  const double margin = 2.0 * radius; // thinner places round the densest reach farther
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
  crowd_.sort({area.left - margin, area.right + margin, area.low - margin, area.high + margin},
              radius, known_);
}

void Births::find(const Area& area, double before, Many& out) const {
  out.size = 0;
  for (std::size_t k = octaves; k-- > 0;) {
    const Octave& octave = octaves_[k];
    if (octave.begin >= before) {
      break;
    }
    const Squares& known = known_[k];
    if (out.x.size() < out.size + known.size + 1) {
      out.resize(2 * (out.size + known.size + 1));
    }
    const std::int64_t top = octave.number(area.high);
    const std::int64_t left = octave.number(area.left), right = octave.number(area.right);
    for (auto row = octave.number(area.low); row <= top; ++row) {
      const std::size_t end = known.end(row, right);
      for (std::size_t i = known.begin(row, left); i < end; ++i) { // as in `Squares::add`
        out.x[out.size] = known.x[i];
        out.y[out.size] = known.y[i];
        out.time[out.size] = known.time[i];
        out.bits[out.size] = known.bits[i];
        out.size += (known.time[i] < before) & (known.x[i] >= area.left) &
                    (known.x[i] < area.right) & (known.y[i] >= area.low) & (known.y[i] < area.high);
      }
    }
  }
}

void Births::Crowd::sort(const Area& gathered, double bucket,
                         const std::array<Squares, octaves>& known) {
  area = gathered;
  per_metre = 1.0 / bucket;
  columns = static_cast<std::size_t>((area.right - area.left) * per_metre) + 2;
  const auto rows = static_cast<std::size_t>((area.high - area.low) * per_metre) + 2;
  first.assign(rows * columns + 2, 0);
  std::size_t size = 0;
  for (const Squares& some : known) {
    for (std::size_t i = 0; i < some.size; ++i) {
      // those of squares that reach over the edge stay with the last bucket inside
      const double u = std::min(std::max(some.x[i], area.left), area.right);
      const double v = std::min(std::max(some.y[i], area.low), area.high);
      ++first[number(u, v) + 2];
    }
    size += some.size;
  }
  for (std::size_t i = 2; i < first.size(); ++i) {
    first[i] += first[i - 1];
  }
  if (x.size() < size + at_once) {
    x.resize(2 * size + at_once);
    y.resize(2 * size + at_once);
    time.resize(2 * size + at_once);
  }
  for (const Squares& some : known) {
    for (std::size_t i = 0; i < some.size; ++i) {
      const double u = std::min(std::max(some.x[i], area.left), area.right);
      const double v = std::min(std::max(some.y[i], area.low), area.high);
      const std::size_t place = first[number(u, v) + 1]++;
      x[place] = some.x[i];
      y[place] = some.y[i];
      time[place] = some.time[i];
    }
  }
  std::fill_n(&time[size], at_once, latest); // none is later
}

namespace {

/// Whether a birth among some is older and nearer; always asks whole groups of `at_once`, for what
/// lies behind the end is a birth as well.
FIRETWIN_CLONES("avx512f", "avx2")
bool crowded(const double* x, const double* y, const double* time, const std::uint32_t* first,
             std::size_t columns, std::size_t rows, std::size_t width, const Births::Birth& birth,
             double square) {
  for (std::size_t row = 0; row < rows; ++row, first += columns) {
    for (std::size_t begin = first[0]; begin < first[width]; begin += at_once) {
      std::int64_t found = 0;
      for (std::size_t i = begin; i < begin + at_once; ++i) {
        const double dx = x[i] - birth.x, dy = y[i] - birth.y;
        found += (time[i] < birth.time) & (dx * dx + dy * dy < square);
      }
      if (found > 0) {
        return true;
      }
    }
  }
  return false;
}

} // namespace

bool Births::stands(const Birth& birth, double reach) const {
  const double square = reach / std::numbers::pi, radius = std::sqrt(square);
  const Area round{birth.x - radius, birth.x + radius, birth.y - radius, birth.y + radius};
  const Area& known = crowd_.area;
  if (!((round.left >= known.left) & (round.right <= known.right) & (round.low >= known.low) &
        (round.high <= known.high))) {
    return stands_anywhere(birth, round, square);
  }
  const std::size_t begin = crowd_.number(round.left, round.low);
  const std::size_t right = crowd_.number(round.right, round.low);
  const std::size_t top = crowd_.number(round.left, round.high);
  return !crowded(crowd_.x.data(), crowd_.y.data(), crowd_.time.data(), &crowd_.first[begin],
                  crowd_.columns, (top - begin) / crowd_.columns + 1, right - begin + 1, birth,
                  square);
}

bool Births::stands_anywhere(const Birth& birth, const Area& round, double square) const {
  for (const Octave& octave : octaves_) {
    if (octave.begin >= birth.time) {
      continue;
    }
    const std::int64_t right = octave.number(round.right), high = octave.number(round.high);
    for (auto row = octave.number(round.low); row <= high; ++row) {
      for (auto column = octave.number(round.left); column <= right; ++column) {
        std::array<std::uint64_t, most> keys;
        const std::size_t count = octave.keys(octave.line(row), column, keys);
        for (std::size_t i = 0; i < count; ++i) {
          const Birth other =
              octave.birth(static_cast<double>(column), static_cast<double>(row), keys[i]);
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
