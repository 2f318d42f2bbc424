#include "flux/arrival.hpp"

#include "flux/crossing_time.hpp"
#include "flux/front_passage.hpp"
#include "flux/fuel.hpp"
#include "flux/ignition_time.hpp"
#include "geo/axis.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace firetwin::flux {
namespace {

bool has_own(const run::Run& run) {
  return run.has("fuel_arrival_time");
}

std::vector<double> own(const run::Run& run) {
  const run::Plane& plane = run.own_arrival_time();
  std::vector<double> result;
  result.reserve(plane.rows() * plane.columns());
  plane.each(
      [&](std::span<const float> time) { result.insert(result.end(), time.begin(), time.end()); });
  return result;
}

/// Interpolates the front passage to `rows` x `columns`; NaN where less than half of the
/// surroundings burns during the run.
std::vector<double> at(const FrontPassage& middle, const run::Run& run,
                       std::span<const double> rows, std::span<const double> columns) {
  const std::size_t nx = run.longitude().size();
  std::vector<double> result(rows.size() * columns.size(), nan);
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t y) {
    const geo::Bracket row = geo::bracket(run.latitude(), rows[y]);
    for (std::size_t x = 0; x < columns.size(); ++x) {
      const geo::Bracket column = geo::bracket(run.longitude(), columns[x]);
      const double time = geo::bilinear(std::span<const double>(middle.time), nx, row, column);
      if (time <= run.times().back() &&
          geo::bilinear(std::span<const float>(middle.burned_fraction), nx, row, column) >= 0.5) {
        result[y * columns.size() + x] = time;
      }
    }
  });
  return result;
}

/// Earliest ignition among the fuel cells of each model cell.
class Earliest {
public:
  explicit Earliest(const run::Run& run)
      : arrival_(run.own_arrival_time()), nx_(run.longitude().size()),
        row_(geo::nearest(run.latitude(), run.fuel_latitude())),
        column_(geo::nearest(run.longitude(), run.fuel_longitude())), result_(run.cells(), nan) {
    for (std::size_t y = 0; y < row_.size(); ++y) {
      if (y == 0 || row_[y] != row_[y - 1]) {
        starts_.push_back(y);
      }
    }
  }

  std::vector<double> find() {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, starts_.size(), rows_at_once),
                      [this](const auto& range) {
                        const std::size_t end = range.end();
                        add(starts_[range.begin()],
                            end < starts_.size() ? starts_[end] : row_.size());
                      });
    return std::move(result_);
  }

private:
  static constexpr std::size_t rows_at_once = 16; ///< of the model grid

  /// Adds the fuel rows `begin` to `end`; reads one more on each side for the slopes.
  void add(std::size_t begin, std::size_t end) {
    const std::size_t first = begin - std::min<std::size_t>(begin, 1), fx = column_.size();
    const std::size_t last = std::min(end + 1, row_.size());
    std::vector<float> time((last - first) * fx);
    arrival_.read(first, time);
    for (std::size_t y = begin; y < end; ++y) {
      for (std::size_t x = 0; x < fx; ++x) {
        const std::size_t i = (y - first) * fx + x;
        if (!std::isnan(time[i])) {
          double& earliest = result_[row_[y] * nx_ + column_[x]];
          earliest = std::fmin(earliest, double{time[i]} - 0.5 * crossing_time(time, fx, i));
        }
      }
    }
  }

  const run::Plane& arrival_;
  std::size_t nx_;
  std::vector<std::size_t> row_,
      column_; ///< row and column of the model grid for each fuel row and column
  std::vector<std::size_t> starts_; ///< first fuel row of each row of the model grid
  std::vector<double> result_;
};

} // namespace

std::vector<double> arrival_time(const run::Run& run) {
  if (!has_own(run)) {
    return at(front_passage_from_flux(run), run, run.latitude(), run.longitude());
  }
  const std::vector<float> time =
      geo::resample(run.own_arrival_time().values(), run.fuel_latitude(), run.fuel_longitude(),
                    run.latitude(), run.longitude());
  return {time.begin(), time.end()};
}

std::vector<double> fuel_arrival_time(const run::Run& run) {
  if (has_own(run)) {
    return own(run);
  }
  std::vector<double> result =
      at(front_passage_from_flux(run), run, run.fuel_latitude(), run.fuel_longitude());
  if (!fuel_of_cells(run).empty()) {
    const std::vector<float> load = fuel_load(run);
    std::transform(result.begin(), result.end(), load.begin(), result.begin(),
                   [](double time, float fuel) { return fuel > 0.0F ? time : nan; });
  }
  return result;
}

std::vector<double> ignition_time(const run::Run& run) {
  return has_own(run) ? Earliest(run).find() : ignition_time_from_flux(run);
}

} // namespace firetwin::flux
