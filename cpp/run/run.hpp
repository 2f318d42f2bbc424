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
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace firetwin::run {

/// A model run on disk. Axes and elevation are in memory; other constant fields and frames are read
/// on demand. Thread-safe.
class Run {
public:
  /// @throws InputError if an axis, the shape of a field or the model times are invalid
  Run(const std::filesystem::path& folder, Description description);

  const std::filesystem::path& path() const { return folder_.path(); }
  const Description& description() const { return description_; }
  const std::vector<std::string>& fields() const { return folder_.fields(); }
  /// Warnings about unusual but usable data, one sentence each. Reads the fuel; includes results of
  /// the heat flux scan once it has run.
  std::vector<std::string> warnings() const;

  const std::vector<double>& times() const { return times_; }       ///< s since start
  const std::vector<double>& latitude() const { return latitude_; } ///< [ny] degrees
  /// [nx] degrees east, without a jump; the centre is in -180..180
  const std::vector<double>& longitude() const { return longitude_; }
  const std::vector<float>& elevation() const { return elevation_; }          ///< [ny nx] m
  const std::vector<double>& fuel_latitude() const { return fuel_latitude_; } ///< [fy]
  /// [fx] degrees east, in the same range as `longitude`
  const std::vector<double>& fuel_longitude() const { return fuel_longitude_; }
  /// [ay], [ax] degrees: axes of fields on levels. Default: axes of the model grid.
  const std::vector<double>& air_latitude() const { return air_latitude_; }
  const std::vector<double>& air_longitude() const { return air_longitude_; }
  const Plane& surface_fuel() const { return *surface_fuel_; } ///< [fy fx] kg/m2
  const Plane& canopy_fuel() const { return *canopy_fuel_; }   ///< [fy fx] kg/m2
  /// [fy fx] m: the run's field, or the elevation resampled bilinearly.
  const Plane& fuel_elevation() const { return *fuel_elevation_; }
  /// [fy fx] fuel model numbers: Anderson 1 to 14, Scott and Burgan 91 to 204.
  /// @throws Error if the run has none
  const Plane& fuel_category() const;

  std::size_t cells() const { return latitude_.size() * longitude_.size(); }
  const Series& heat_flux() const { return *heat_flux_; } ///< W/m2
  /// Burned fraction of each fuel cell [fy fx], 0..1. @throws Error if the run has none
  const Series& burned_fraction() const;
  /// Surface fields on the model grid, resampled bilinearly from `air_latitude` and
  /// `air_longitude`.
  /// @throws Error if the run has none
  const Series& temperature() const; ///< K
  const Series& wind_east() const;   ///< m/s
  const Series& wind_north() const;  ///< m/s

  bool has(const std::string& field) const { return folder_.has(field); }
  /// Fields on terrain-following levels [nz ay ax]. A run with one of the others has height_3d (m).
  /// @throws Error if the run has none
  const LevelSeries& smoke_3d() const;       ///< kg/m3
  const LevelSeries& height_3d() const;      ///< m
  const LevelSeries& temperature_3d() const; ///< K

  /// Smallest and largest finite heat flux of the complete run, W/m2; 0 and 0 without finite
  /// values. Uses the scan.
  std::pair<float, float> flux_range() const;
  /// Statistics of one pass over all heat fluxes; computed once, on first use.
  const Scan& scan() const;
  /// [fy fx] s, NaN if never: the field fuel_arrival_time. @throws Error if the run has none
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

  /// Threads that wait for the scan take part in it, since one of them may hold a task that it
  /// needs.
  mutable tbb::collaborative_once_flag once_;
  mutable std::optional<Scan> scan_;
  mutable std::atomic<bool> scanned_ = false;
  mutable tbb::collaborative_once_flag arrival_once_;
  mutable std::optional<Plane> own_arrival_;
};

} // namespace firetwin::run
