#include "run/run.hpp"

#include "base/error.hpp"
#include "geo/axis.hpp"
#include "io/name.hpp"
#include "run/axis_file.hpp"
#include "run/grid_file.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace firetwin::run {
namespace {

template <class Test> std::size_t count(std::span<const float> values, Test test) {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), test));
}

bool not_finite(float value) {
  return !std::isfinite(value);
}

/// Adds warnings about the values of a fuel field.
void add_odd(const std::string& name, const Plane& fuel, std::vector<std::string>& warnings) {
  std::size_t without = 0, negative = 0;
  fuel.each([&](std::span<const float> values) {
    without += count(values, not_finite);
    negative += count(values, [](float v) { return v < 0.0F; });
  });
  if (without > 0) {
    warnings.push_back(name + " has no value in " + std::to_string(without) + " cells");
  }
  if (negative > 0) {
    warnings.push_back(name + " is negative in " + std::to_string(negative) + " cells");
  }
}

bool reaches_beyond(const std::vector<double>& fine, const std::vector<double>& coarse) {
  const auto [low, high] = std::minmax_element(fine.begin(), fine.end());
  const geo::Extent first = geo::cell_extent(coarse, 0);
  const geo::Extent last = geo::cell_extent(coarse, coarse.size() - 1);
  const double slack = 1e-6;
  return *low < std::min(first.first, last.last) - slack ||
         *high > std::max(first.first, last.last) + slack;
}

template <class Field>
const Field& need(const std::optional<Field>& series, const std::filesystem::path& folder,
                  const std::string& name) {
  if (!series) {
    throw Error(io::utf8(folder) + ": this run has no " + name);
  }
  return *series;
}

} // namespace

Run::Run(const std::filesystem::path& folder, Description description)
    : folder_(folder), description_(std::move(description)) {
  if (description_.no_data) {
    no_data_ = static_cast<float>(*description_.no_data);
  }
  warnings_ = description_.warnings;
  for (const std::string& name : folder_.strangers()) {
    warnings_.push_back(name + " is not a field of a run and is ignored");
  }
  read_axes();
  read_grids();
  open_series();
  open_levels();
  set_times();
  check_order();
  check_places();
}

void Run::read_axes() {
  latitude_ = read_latitude(folder_.field_file("latitude"));
  longitude_ = read_longitude(folder_.field_file("longitude"), 0.0);
  fuel_latitude_ = read_latitude(folder_.field_file("fuel_latitude"));
  const double middle = 0.5 * (longitude_.front() + longitude_.back());
  fuel_longitude_ = read_longitude(folder_.field_file("fuel_longitude"), middle);
  if (!folder_.has("air_latitude") && !folder_.has("air_longitude")) {
    air_latitude_ = latitude_;
    air_longitude_ = longitude_;
    return;
  }
  air_latitude_ = read_latitude(folder_.field_file("air_latitude"));
  air_longitude_ = read_longitude(folder_.field_file("air_longitude"), middle);
}

void Run::emplace(std::optional<Plane>& plane, const std::string& field) const {
  plane.emplace(folder_.field_file(field), fuel_latitude_.size(), fuel_longitude_.size(), no_data_);
}

void Run::read_grids() {
  elevation_.resize(cells());
  read_grid(folder_.field_file("elevation"), latitude_.size(), longitude_.size(), no_data_,
            elevation_);
  emplace(surface_fuel_, "surface_fuel");
  emplace(canopy_fuel_, "canopy_fuel");
  if (folder_.has("fuel_category")) {
    emplace(fuel_category_, "fuel_category");
  }
  if (folder_.has("fuel_elevation")) {
    emplace(fuel_elevation_, "fuel_elevation");
    return;
  }
  const auto resampled = [this] {
    return geo::resample(elevation_, latitude_, longitude_, fuel_latitude_, fuel_longitude_);
  };
  fuel_elevation_.emplace(resampled, fuel_latitude_.size(), fuel_longitude_.size());
}

std::optional<Series> Run::optional_series(const std::string& field,
                                           const std::vector<double>& rows,
                                           const std::vector<double>& columns) const {
  if (!folder_.has(field)) {
    return std::nullopt;
  }
  Series series = folder_.series(field, rows.size(), columns.size(), no_data_);
  if (series.size() != heat_flux_->size()) {
    io::fail(path() / field,
             "has " + std::to_string(series.size()) + " times where heat_flux has " +
                 std::to_string(heat_flux_->size()) + "; every field needs all times");
  }
  return series;
}

std::optional<Series> Run::optional_air(const std::string& field) const {
  std::optional<Series> series = optional_series(field, air_latitude_, air_longitude_);
  if (!series || !folder_.has("air_latitude")) {
    return series;
  }
  return std::move(*series).onto(air_latitude_, air_longitude_, latitude_, longitude_);
}

void Run::open_series() {
  heat_flux_ = folder_.series("heat_flux", latitude_.size(), longitude_.size(), no_data_);
  burned_fraction_ = optional_series("burned_fraction", fuel_latitude_, fuel_longitude_);
  temperature_ = optional_air("temperature");
  wind_east_ = optional_air("wind_east");
  wind_north_ = optional_air("wind_north");
  if (wind_east_.has_value() != wind_north_.has_value()) {
    io::fail(path() / (wind_east_ ? "wind_north" : "wind_east"),
             "the field is missing; wind needs wind_east and wind_north");
  }
}

std::optional<LevelSeries> Run::optional_levels(const std::string& field, bool steady) const {
  if (!folder_.has(field)) {
    return std::nullopt;
  }
  return LevelSeries(NpyFile(folder_.npy_file(field)), heat_flux_->size(), air_latitude_.size(),
                     air_longitude_.size(), steady, no_data_);
}

void Run::open_levels() {
  smoke_3d_ = optional_levels("smoke_3d", false);
  temperature_3d_ = optional_levels("temperature_3d", false);
  height_3d_ = optional_levels("height_3d", true);
  for (const std::optional<LevelSeries>* field : {&smoke_3d_, &temperature_3d_}) {
    if (!*field) {
      continue;
    }
    if (!height_3d_) {
      io::fail(path() / "height_3d.npy",
               "the field is missing; fields on levels need the heights of the levels");
    }
    if ((*field)->levels() != height_3d_->levels()) {
      io::fail((*field)->path(),
               "has " + std::to_string((*field)->levels()) + " levels where height_3d has " +
                   std::to_string(height_3d_->levels()) + "; save both on the same levels");
    }
  }
}

void Run::set_times() {
  const std::size_t nt = heat_flux_->size();
  times_ = description_.times_s;
  if (description_.interval_s) {
    times_.resize(nt);
    for (std::size_t i = 0; i < nt; ++i) {
      times_[i] = static_cast<double>(i) * *description_.interval_s;
    }
  }
  if (times_.size() != nt) {
    io::fail(path() / "run.toml", "times_s lists " + std::to_string(times_.size()) +
                                      " times but heat_flux has " + std::to_string(nt));
  }
  if (!std::isfinite(times_.back())) {
    io::fail(path() / "run.toml", "interval_s is so long that the last time is not a number");
  }
  if (std::adjacent_find(times_.begin(), times_.end(), std::greater_equal<>()) != times_.end()) {
    io::fail(path() / "run.toml", "times must ascend; correct interval_s or times_s");
  }
}

void Run::check_order() {
  const auto check = [this](const std::string& field, const auto& series) {
    if (series && series->scattered()) {
      warnings_.push_back(field + ".npy is in Fortran order, so that reading one time scans the "
                                  "complete file; save it with numpy.ascontiguousarray");
    }
  };
  check("heat_flux", heat_flux_);
  check("burned_fraction", burned_fraction_);
  check("temperature", temperature_);
  check("wind_east", wind_east_);
  check("wind_north", wind_north_);
  check("smoke_3d", smoke_3d_);
  check("height_3d", height_3d_);
  check("temperature_3d", temperature_3d_);
}

void Run::check_places() {
  if (const std::size_t n = count(elevation_, not_finite)) {
    warnings_.push_back("elevation has no value in " + std::to_string(n) + " cells");
  }
  if (reaches_beyond(fuel_latitude_, latitude_) || reaches_beyond(fuel_longitude_, longitude_)) {
    warnings_.push_back("the fuel grid reaches beyond the model grid");
  }
}

std::vector<std::string> Run::warnings() const {
  std::vector<std::string> result = warnings_;
  add_odd("surface_fuel", *surface_fuel_, result);
  add_odd("canopy_fuel", *canopy_fuel_, result);
  if (!scanned_) {
    return result;
  }
  if (scan_->smallest > scan_->largest) {
    result.push_back("heat_flux has no finite value at any time, so nothing burns by it");
  } else if (scan_->not_finite) {
    result.push_back("heat_flux has no value " + std::to_string(scan_->not_finite) + " times");
  }
  if (scan_->negative) {
    result.push_back("heat_flux is negative " + std::to_string(scan_->negative) + " times");
  }
  return result;
}

const Series& Run::burned_fraction() const {
  return need(burned_fraction_, path(), "burned_fraction");
}
const Series& Run::temperature() const {
  return need(temperature_, path(), "temperature");
}
const Series& Run::wind_east() const {
  return need(wind_east_, path(), "wind");
}
const Series& Run::wind_north() const {
  return need(wind_north_, path(), "wind");
}

const Plane& Run::fuel_category() const {
  return need(fuel_category_, path(), "fuel_category");
}

const LevelSeries& Run::smoke_3d() const {
  return need(smoke_3d_, path(), "smoke_3d");
}
const LevelSeries& Run::height_3d() const {
  return need(height_3d_, path(), "height_3d");
}
const LevelSeries& Run::temperature_3d() const {
  return need(temperature_3d_, path(), "temperature_3d");
}

const Scan& Run::scan() const {
  tbb::collaborative_call_once(once_, [this] {
    scan_ = run::scan(*heat_flux_, times_);
    scanned_ = true;
  });
  return *scan_;
}

std::pair<float, float> Run::flux_range() const {
  const Scan& all = scan();
  if (all.smallest > all.largest) { // no finite value
    return {0.0F, 0.0F};
  }
  return {all.smallest, all.largest};
}

const Plane& Run::own_arrival_time() const {
  tbb::collaborative_call_once(arrival_once_, [this] {
    own_arrival_.emplace(folder_.field_file("fuel_arrival_time"), fuel_latitude_.size(),
                         fuel_longitude_.size(), no_data_, description_.zero_s);
  });
  return *own_arrival_;
}

} // namespace firetwin::run
