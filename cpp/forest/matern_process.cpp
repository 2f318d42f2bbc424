#include "forest/matern_process.hpp"

#include "base/clones.hpp"

#include <algorithm>
#include <numbers>

namespace firetwin::forest {
namespace {

constexpr std::size_t at_once = 4; ///< points

/// 21 bits as a number in [0, 1), by a conversion that vectorizes.
double part(std::uint64_t bits) {
  return static_cast<double>(static_cast<std::int32_t>(bits & 0x1FFFFF)) * 0x1p-21;
}

} // namespace

MaternProcess::MaternProcess(std::uint64_t seed) {
  for (std::size_t k = 0; k < octaves; ++k) {
    Octave& octave = octaves_[k];
    octave.seed = mix(mix(seed), k);
    octave.end = std::ldexp(max_mark, -2 * static_cast<int>(k));
    octave.begin = k + 1 == octaves ? 0.0 : 0.25 * octave.end;
    octave.side = 1.0 / std::sqrt(octave.end - octave.begin);
    octave.per_metre = 1.0 / octave.side;
  }
}

namespace {

/// Solves part = 1 - exp(-chance part), with `chance` points per exclusion disc on average.
double solve(double chance) {
  double part = 1.0;
  for (int i = 0; i < 5; ++i) {
    part = -std::expm1(-chance * part);
  }
  return part;
}

/// The solution for sparse stands, where `max_mark_ratio` limits the marks instead of `max_mark`.
const double sparse = solve(MaternProcess::max_mark_ratio),
             sparse_end = std::expm1(-MaternProcess::max_mark_ratio * sparse);

bool is_sparse(double density) {
  return MaternProcess::max_mark >= MaternProcess::max_mark_ratio * density;
}

} // namespace

double MaternProcess::exclusion_area(double density) {
  return (is_sparse(density) ? sparse : solve(max_mark / density)) / density;
}

double MaternProcess::older_fraction(double mark, double density) {
  const double area = exclusion_area(density);
  return std::expm1(-mark * area) /
         (is_sparse(density) ? sparse_end : std::expm1(-max_mark * area));
}

std::size_t MaternProcess::Octave::keys(std::uint64_t line, std::int64_t column,
                                        std::span<std::uint64_t, most> out) const {
  // Cumulative Poisson distribution with mean 1; more than 7 points occur once in 100,000 squares
  // and are truncated. Comparing eight numbers is as fast as seven.
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

MaternProcess::MarkedPoint MaternProcess::Octave::point(double column, double row,
                                                        std::uint64_t key) const {
  MarkedPoint one{};
  points(row, 1, &column, &key, &one.x, &one.y, &one.mark, &one.bits);
  return one;
}

FIRETWIN_CLONES("avx512f", "avx2")
void MaternProcess::Octave::points(double row, std::size_t n, const double* column,
                                   const std::uint64_t* key, double* __restrict x,
                                   double* __restrict y, double* __restrict mark,
                                   std::uint64_t* __restrict bits) const {
  const double across = side, first = begin, more = end - begin;
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint64_t found = mix(key[i]);
    bits[i] = found;
    x[i] = (column[i] + part(found >> 43)) * across;
    y[i] = (row + part(found >> 22)) * across;
    mark[i] = first + more * part(found >> 1);
  }
}

/// Branch-free on random values: writes every candidate and advances only past valid ones.
void MaternProcess::Squares::add(const Octave& octave, std::int64_t at_row, double before,
                                 Row& work) {
  const auto width = static_cast<std::size_t>(columns);
  const std::uint64_t line = octave.line(at_row);
  std::size_t points = 0;
  work.resize((width + 1) * most);
  for (std::size_t i = 0; i < width; ++i) {
    const std::int64_t at = column + static_cast<std::int64_t>(i);
    std::fill_n(&work.column[points], most, static_cast<double>(at));
    work.begin[i] = points;
    points += octave.keys(line, at, std::span<std::uint64_t, most>(&work.key[points], most));
  }
  if (x.size() < size + points + 1) {
    resize(2 * (size + points + 1));
  }
  const std::size_t begin = size;
  octave.points(static_cast<double>(at_row), points, work.column.data(), work.key.data(), &x[begin],
                &y[begin], &mark[begin], &bits[begin]);
  for (std::size_t i = begin; i < begin + points; ++i) {
    const double when = mark[i];
    x[size] = x[i];
    y[size] = y[i];
    mark[size] = when;
    bits[size] = bits[i];
    work.place[i - begin] = static_cast<std::uint32_t>(size);
    size += when < before;
  }
  work.place[points] = static_cast<std::uint32_t>(size);
  for (std::size_t i = 0; i < width; ++i) {
    first.push_back(work.place[work.begin[i]]);
  }
}

void MaternProcess::Row::resize(std::size_t points) {
  if (key.size() < points) {
    key.resize(points);
    column.resize(points);
    place.resize(points);
    begin.resize(points);
  }
}

void MaternProcess::PointArrays::resize(std::size_t points) {
  x.resize(points);
  y.resize(points);
  mark.resize(points);
  bits.resize(points);
}

void MaternProcess::gather(const Area& area, double before) {
  // In very sparse stands discs are unbounded; points beyond the margin are tested one by one.
  const double radius =
      std::min(std::sqrt(exclusion_area(std::min(before / max_mark_ratio, max_stem_density)) /
                         std::numbers::pi),
               4.0 * octaves_.back().side);
  const double margin = 2.0 * radius; // sparser places around the densest have larger discs
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
  buckets_.sort({area.left - margin, area.right + margin, area.low - margin, area.high + margin},
                radius, known_);
}

void MaternProcess::find(const Area& area, double before, PointArrays& out) const {
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
        out.mark[out.size] = known.mark[i];
        out.bits[out.size] = known.bits[i];
        out.size += (known.mark[i] < before) & (known.x[i] >= area.left) &
                    (known.x[i] < area.right) & (known.y[i] >= area.low) & (known.y[i] < area.high);
      }
    }
  }
}

void MaternProcess::PointBuckets::sort(const Area& gathered, double bucket,
                                       const std::array<Squares, octaves>& known) {
  area = gathered;
  per_metre = 1.0 / bucket;
  columns = static_cast<std::size_t>((area.right - area.left) * per_metre) + 2;
  const auto rows = static_cast<std::size_t>((area.high - area.low) * per_metre) + 2;
  first.assign(rows * columns + 2, 0);
  std::size_t size = 0;
  for (const Squares& some : known) {
    for (std::size_t i = 0; i < some.size; ++i) {
      // points of squares that cross the edge go to the last bucket inside
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
    mark.resize(2 * size + at_once);
  }
  for (const Squares& some : known) {
    for (std::size_t i = 0; i < some.size; ++i) {
      const double u = std::min(std::max(some.x[i], area.left), area.right);
      const double v = std::min(std::max(some.y[i], area.low), area.high);
      const std::size_t place = first[number(u, v) + 1]++;
      x[place] = some.x[i];
      y[place] = some.y[i];
      mark[place] = some.mark[i];
    }
  }
  std::fill_n(&mark[size], at_once, max_mark); // no mark is larger
}

namespace {

/// True if one of the points has a smaller mark and is nearer. Tests complete groups of `at_once`;
/// padding points follow the last one.
FIRETWIN_CLONES("avx512f", "avx2")
bool has_older_neighbour(const double* x, const double* y, const double* mark,
                         const std::uint32_t* first, std::size_t columns, std::size_t rows,
                         std::size_t width, const MaternProcess::MarkedPoint& point,
                         double square) {
  for (std::size_t row = 0; row < rows; ++row, first += columns) {
    for (std::size_t begin = first[0]; begin < first[width]; begin += at_once) {
      std::int64_t found = 0;
      for (std::size_t i = begin; i < begin + at_once; ++i) {
        const double dx = x[i] - point.x, dy = y[i] - point.y;
        found += (mark[i] < point.mark) & (dx * dx + dy * dy < square);
      }
      if (found > 0) {
        return true;
      }
    }
  }
  return false;
}

} // namespace

bool MaternProcess::is_retained(const MarkedPoint& point, double reach) const {
  const double square = reach / std::numbers::pi, radius = std::sqrt(square);
  const Area round{point.x - radius, point.x + radius, point.y - radius, point.y + radius};
  const Area& known = buckets_.area;
  if (!((round.left >= known.left) & (round.right <= known.right) & (round.low >= known.low) &
        (round.high <= known.high))) {
    return is_retained_anywhere(point, round, square);
  }
  const std::size_t begin = buckets_.number(round.left, round.low);
  const std::size_t right = buckets_.number(round.right, round.low);
  const std::size_t top = buckets_.number(round.left, round.high);
  return !has_older_neighbour(
      buckets_.x.data(), buckets_.y.data(), buckets_.mark.data(), &buckets_.first[begin],
      buckets_.columns, (top - begin) / buckets_.columns + 1, right - begin + 1, point, square);
}

bool MaternProcess::is_retained_anywhere(const MarkedPoint& point, const Area& round,
                                         double square) const {
  for (const Octave& octave : octaves_) {
    if (octave.begin >= point.mark) {
      continue;
    }
    const std::int64_t right = octave.number(round.right), high = octave.number(round.high);
    for (auto row = octave.number(round.low); row <= high; ++row) {
      for (auto column = octave.number(round.left); column <= right; ++column) {
        std::array<std::uint64_t, most> keys;
        const std::size_t count = octave.keys(octave.line(row), column, keys);
        for (std::size_t i = 0; i < count; ++i) {
          const MarkedPoint other =
              octave.point(static_cast<double>(column), static_cast<double>(row), keys[i]);
          const double dx = other.x - point.x, dy = other.y - point.y;
          if ((other.mark < point.mark) & (dx * dx + dy * dy < square)) {
            return false;
          }
        }
      }
    }
  }
  return true;
}

} // namespace firetwin::forest
