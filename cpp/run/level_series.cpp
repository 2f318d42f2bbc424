#include "run/level_series.hpp"

#include "geo/axis.hpp"
#include "io/name.hpp"
#include "run/grid_file.hpp"

#include <stdexcept>
#include <string>
#include <utility>

namespace firetwin::run {

LevelSeries::LevelSeries(NpyFile file, std::size_t times, std::size_t rows, std::size_t columns,
                         bool steady, std::optional<float> no_data)
    : file_(std::move(file)), times_(times), steady_(false), levels_(0), cells_(0),
      no_data_(no_data) {
  const std::vector<std::size_t>& shape = file_.shape();
  const std::size_t dimensions = shape.size();
  steady_ = steady && dimensions == 3;
  const bool fits = (steady_ || (dimensions == 4 && shape[0] == times)) &&
                    shape[dimensions - 2] == rows && shape[dimensions - 1] == columns &&
                    shape[dimensions - 3] >= 2;
  if (!fits) {
    const std::string grid =
        "levels, " + std::to_string(rows) + ", " + std::to_string(columns) + ")";
    io::fail(path(), "expected shape (" + std::to_string(times) + ", " + grid +
                         (steady ? " or (" + grid : "") + " with two levels or more, found " +
                         shape_text(shape) + "; make the field fit the times and the axes");
  }
  levels_ = shape[dimensions - 3];
  cells_ = levels_ * rows * columns;
}

void LevelSeries::read(std::size_t index, std::span<float> out) const {
  if (index >= times_) {
    throw std::out_of_range("time index " + std::to_string(index) + " of a run with " +
                            std::to_string(times_) + " times");
  }
  file_.read(steady_ ? 0 : index, out);
  blank(out, no_data_);
}

void LevelSeries::read_at(double time, std::span<const double> times, std::span<float> out) const {
  const geo::Bracket between = geo::bracket(times, time);
  read(between.lower, out);
  if (steady_ || between.upper == between.lower || between.fraction == 0.0) {
    return;
  }
  std::vector<float> next(out.size());
  read(between.upper, next);
  const auto part = static_cast<float>(between.fraction);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = (1.0F - part) * out[i] + part * next[i];
  }
}

} // namespace firetwin::run
