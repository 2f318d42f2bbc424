#include "run/scan.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace firetwin::run {
namespace {

Scan empty_scan(std::size_t cells) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  return {infinity, -infinity, 0, 0, std::vector<std::uint32_t>(cells, Scan::never)};
}

void add_frame(Scan& scan, std::span<const float> flux, std::uint32_t index, double threshold) {
  for (std::size_t i = 0; i < flux.size(); ++i) {
    const float f = flux[i];
    if (!std::isfinite(f)) {
      ++scan.not_finite;
      continue;
    }
    scan.smallest = std::min(scan.smallest, f);
    scan.largest = std::max(scan.largest, f);
    scan.negative += f < 0.0F;
    if (double{f} > threshold) {
      scan.first[i] = std::min(scan.first[i], index);
    }
  }
}

/// Every member combines by minimum, maximum or integer sum: any order gives the same.
Scan merge(Scan a, const Scan& b) {
  a.smallest = std::min(a.smallest, b.smallest);
  a.largest = std::max(a.largest, b.largest);
  a.not_finite += b.not_finite;
  a.negative += b.negative;
  for (std::size_t i = 0; i < a.first.size(); ++i) {
    a.first[i] = std::min(a.first[i], b.first[i]);
  }
  return a;
}

} // namespace

Scan scan(const Series& flux, double threshold) {
  constexpr std::size_t times_per_task = 64;
  const std::size_t cells = flux.cells();
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, flux.size(), times_per_task), empty_scan(cells),
      [&](const tbb::blocked_range<std::size_t>& range, Scan part) {
        std::vector<float> frame(cells);
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          flux.read(i, frame);
          add_frame(part, frame, static_cast<std::uint32_t>(i), threshold);
        }
        return part;
      },
      [](Scan a, const Scan& b) { return merge(std::move(a), b); });
}

} // namespace firetwin::run
