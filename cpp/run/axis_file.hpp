#pragma once

#include <filesystem>
#include <vector>

namespace firetwin::run {

/// Reads an axis of degrees north: one line or one column of text, or a one-dimensional .npy.
/// @throws InputError when it is not strictly monotone, or not finite and within +-90.
std::vector<double> read_latitude(const std::filesystem::path& path);

/// Reads an axis of degrees east in the same way. It may count from -180 to 180, from 0 to 360 or
/// beyond, and jump once by a whole turn where it crosses the antimeridian (179, 180, -179); what
/// is given has no jump (179, 180, 181), and its middle is within half a turn of `around`.
/// @throws InputError when it still is not strictly monotone, goes more than once around, or has
///         values that are not finite and within +-540.
std::vector<double> read_longitude(const std::filesystem::path& path, double around);

} // namespace firetwin::run
