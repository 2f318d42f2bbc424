#pragma once

#include <filesystem>
#include <vector>

namespace firetwin::run {

/// Reads latitudes in degrees north: one line or one column of text, or a one-dimensional .npy.
/// @throws InputError unless they are strictly monotonic, finite and within +-90
std::vector<double> read_latitude(const std::filesystem::path& path);

/// Reads longitudes in degrees east in the same way. They may be in -180..180, 0..360 or beyond,
/// and jump once by 360 degrees at the antimeridian (179, 180, -179). The result has no jump (179,
/// 180, 181), and its centre is within 180 degrees of `around`.
/// @throws InputError unless the result is strictly monotonic, spans at most 360 degrees, and is
/// finite and within +-540
std::vector<double> read_longitude(const std::filesystem::path& path, double around);

} // namespace firetwin::run
