#include "terrain/interpolate.hpp"

#include "base/interpolation.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <cstddef>

namespace firetwin::terrain {
namespace {

template <class T>
void each(const Field<T>& field, std::span<const double> row, std::span<const double> column,
          std::span<double> out) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, row.size(), 4096), [&](const auto& range) {
    double* to = out.data() + range.begin() * static_cast<std::size_t>(field.bands);
    for (std::size_t k = range.begin(); k < range.end(); ++k) {
      const auto y = interval_extended(row[k], field.rows);
      const auto x = interval_extended(column[k], field.columns);
      const T* first = field.values + (y.low * field.columns + x.low) * field.bands;
      const std::int64_t north = (y.high - y.low) * field.columns * field.bands;
      const std::int64_t east = (x.high - x.low) * field.bands;
      for (std::int64_t band = 0; band < field.bands; ++band) {
        const auto corner = [first, north, east, band](std::int64_t j, std::int64_t i) {
          return double{first[j * north + i * east + band]};
        };
        *to++ = bilinear<ExactLerp>(corner, y.part, x.part);
      }
    }
  });
}

} // namespace

void interpolate(const Field<float>& field, std::span<const double> row,
                 std::span<const double> column, std::span<double> out) {
  each(field, row, column, out);
}

void interpolate(const Field<double>& field, std::span<const double> row,
                 std::span<const double> column, std::span<double> out) {
  each(field, row, column, out);
}

} // namespace firetwin::terrain
