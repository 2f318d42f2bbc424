#pragma once

#include "run/description.hpp"
#include "run/folder.hpp"
#include "run/level_series.hpp"
#include "run/plane.hpp"
#include "run/scan.hpp"
#include "run/series.hpp"

#include <oneapi/tbb/collaborative_call_once.h>

#include <atomic>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace firetwin::run {

/// A model run on disk. Axes and elevation are in memory; what else does not change is read when
/// asked for, as a whole or some rows of it, and so are frames.
/// All of it may be used from several threads.
class Run {
public:
  /// @throws InputError for everything that is wrong with run.toml, the axes, a field's shape
  /// or
  ///         the number of model times.
  explicit Run(const std::filesystem::path& folder);

  const std::filesystem::path& path() const { return folder_.path(); }
  const Description& description() const { return description_; }
  const std::vector<std::string>& fields() const { return folder_.fields(); }
  /// What is odd but usable, one sentence each; reads the fuel, and a scan of the heat flux adds to
  /// it.
  std::vector<std::string> warnings() const;

  const std::vector<double>& times() const { return times_; }       ///< s since start
  const std::vector<double>& latitude() const { return latitude_; } ///< [ny] degrees
  /// [nx] degrees east, without a jump; the middle lies in -180..180
  const std::vector<double>& longitude() const { return longitude_; }
  const std::vector<float>& elevation() const { return elevation_; }          ///< [ny nx] m
  const std::vector<double>& fuel_latitude() const { return fuel_latitude_; } ///< [fy]
  /// [fx] degrees east, counted as `longitude` is
  const std::vector<double>& fuel_longitude() const { return fuel_longitude_; }
  /// [ay], [ax] degrees of what is on levels: the run's axes of that name, else the model grid's.
  const std::vector<double>& air_latitude() const { return air_latitude_; }
  const std::vector<double>& air_longitude() const { return air_longitude_; }
  const Plane& surface_fuel() const { return *surface_fuel_; } ///< [fy fx] kg/m2
  const Plane& canopy_fuel() const { return *canopy_fuel_; }   ///< [fy fx] kg/m2
  /// [fy fx] m: the field of that name, or the elevation resampled bilinearly.
  const Plane& fuel_elevation() const { return *fuel_elevation_; }
  /// [fy fx] number of the fuel model: Anderson 1 to 14, Scott and Burgan 91 to 204.
  /// @throws Error when the run has none.
  const Plane& fuel_category() const;

  std::size_t cells() const { return latitude_.size() * longitude_.size(); }
  const Series& heat_flux() const { return *heat_flux_; } ///< W/m2
  /// Of each fuel cell [fy fx], 0..1 at each time. @throws Error when the run has none.
  const Series& burned_fraction() const;
  /// On the model grid: bilinear between the places of `air_latitude` and `air_longitude`.
  /// @throws Error when the run has none.
  const Series& temperature() const; ///< K
  const Series& wind_east() const;   ///< m/s
  const Series& wind_north() const;  ///< m/s

  bool has(const std::string& field) const { return folder_.has(field); }
  /// On terrain-following levels, [nz ay ax]; height_3d (m) is there where one of the others is.
  /// @throws Error when the run has none.
  const LevelSeries& smoke_3d() const;       ///< kg/m3
  const LevelSeries& height_3d() const;      ///< m
  const LevelSeries& temperature_3d() const; ///< K

  /// Smallest and largest finite heat flux of the whole run, W/m2; 0 and 0 where none is finite.
  /// Asks for the scan.
  std::pair<float, float> flux_range() const;
  /// What one pass over every heat flux tells; made when it is first asked for, and once.
  const Scan& scan() const;
  /// [fy fx] s, NaN where never: the field of that name. @throws Error when the run has none.
  const Plane& own_arrival_time() const;

private:
  void read_axes();
  void read_grids();
  void open_series();
  void set_times();
  void check_order();
  void check_places();
  void emplace(std::optional<Plane>& plane, const std::string& field) const;
  void open_levels();
  std::optional<Series> optional_series(const std::string& field, const std::vector<double>& rows,
                                        const std::vector<double>& columns) const;
  std::optional<Series> optional_air(const std::string& field) const;
  std::optional<LevelSeries> optional_levels(const std::string& field, bool steady) const;

  Folder folder_;
  Description description_;
  std::optional<float> no_data_;
  std::vector<double> times_, latitude_, longitude_, fuel_latitude_, fuel_longitude_;
  std::vector<double> air_latitude_, air_longitude_;
  std::vector<float> elevation_;
  std::optional<Plane> surface_fuel_, canopy_fuel_, fuel_elevation_, fuel_category_;
  std::optional<Series> heat_flux_, burned_fraction_, temperature_, wind_east_, wind_north_;
  std::optional<LevelSeries> smoke_3d_, height_3d_, temperature_3d_;
  std::vector<std::string> warnings_;

  /// Threads that wait for the scan take part in it: one of them could hold what it needs.
  mutable tbb::collaborative_once_flag once_;
  mutable std::optional<Scan> scan_;
  mutable std::atomic<bool> scanned_ = false;
  mutable std::once_flag arrival_once_;
  mutable std::optional<Plane> own_arrival_;
};

} // namespace firetwin::run
