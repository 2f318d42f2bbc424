#include "run/scan.hpp"

#include "run/not_zero.hpp"
#include "run/read_ahead.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace firetwin::run {
namespace {

constexpr std::size_t chunk = 1U << 15U;

/// A frame with its time and weight.
struct Frame {
  std::span<const float> flux;
  std::uint32_t index;
  bool last;
  double time;  ///< s after the first
  double share; ///< integration weight, s
};

/// A part of the cells and its statistics.
struct Part {
  float smallest = std::numeric_limits<float>::infinity();
  float largest = -std::numeric_limits<float>::infinity();
  std::size_t not_finite = 0;
  std::size_t negative = 0;
  std::vector<std::size_t> begun; ///< cells that ignited at the previous frame

  void add(std::span<Scan::Cell> cells, const Frame& frame);

private:
  void add(std::span<Scan::Cell> cells, std::size_t i, const Frame& frame);
};

void Part::add(std::span<Scan::Cell> cells, const Frame& frame) {
  for (const std::size_t i : begun) {
    cells[i].next = frame.flux[i];
  }
  begun.clear();
  const std::size_t others =
      each_not_zero(frame.flux, [&](std::size_t i) { add(cells, i, frame); });
  if (others < frame.flux.size()) {
    smallest = std::min(smallest, 0.0F);
    largest = std::max(largest, 0.0F);
  }
}

void Part::add(std::span<Scan::Cell> cells, std::size_t i, const Frame& frame) {
  const float flux = frame.flux[i];
  if (!std::isfinite(flux)) {
    ++not_finite;
    return;
  }
  smallest = std::min(smallest, flux);
  largest = std::max(largest, flux);
  if (flux < 0.0F) {
    ++negative;
    return;
  }
  Scan::Cell& cell = cells[i];
  if (flux >= min_fire_flux && cell.first == Scan::never) {
    cell.first = frame.index;
    cell.flux = flux;
    cell.next = std::numeric_limits<float>::quiet_NaN();
    begun.push_back(i);
  }
  const double heat = double{flux} * frame.share;
  cell.heat += heat;
  cell.moment += heat * frame.time;
  cell.last = frame.last ? flux : 0.0F;
}

double share(const std::vector<double>& times, std::size_t i) {
  const double before = i > 0 ? times[i] - times[i - 1] : 0.0;
  const double after = i + 1 < times.size() ? times[i + 1] - times[i] : 0.0;
  return 0.5 * (before + after);
}

} // namespace

Scan scan(const Series& flux, const std::vector<double>& times) {
  std::vector<std::size_t> all(flux.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::size_t readers = std::clamp<std::size_t>(
      static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()), 1, 8);
  ReadAhead frames(flux, all, 2 * readers, readers);
  Scan result;
  result.cells.resize(flux.cells());
  const std::span<Scan::Cell> cells = result.cells;
  std::vector<Part> parts((cells.size() + chunk - 1) / chunk);
  std::vector<float> values;
  for (std::size_t i = 0; frames.next(values); ++i) {
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t k) {
      const std::size_t begin = k * chunk, size = std::min(chunk, cells.size() - begin);
      parts[k].add(cells.subspan(begin, size),
                   {std::span(values).subspan(begin, size), static_cast<std::uint32_t>(i),
                    i + 1 == all.size(), times[i] - times.front(), share(times, i)});
    });
  }
  for (const Part& part : parts) {
    result.smallest = std::min(result.smallest, part.smallest);
    result.largest = std::max(result.largest, part.largest);
    result.not_finite += part.not_finite;
    result.negative += part.negative;
  }
  return result;
}

} // namespace firetwin::run
