#pragma once

#include "flames/flames.hpp"
#include "io/metadata.hpp"
#include "volume/vdb_summary.hpp"

#include <cstddef>
#include <filesystem>
#include <span>

namespace firetwin::volume {

constexpr std::size_t flame_values = 3; ///< of `sample_flames` at a point

/// Samples flames at points (n, 3), m: (n, 3) extinction in visible light and in the infrared, 1/m,
/// and temperature, K, which is 0 without flames. Eddies below the size `fine`, m, are left out.
/// Cooled soot over the flames is not included.
/// @throws std::invalid_argument
void sample_flames(const flames::FlameVolume& flames, std::span<const double> points, float fine,
                   std::span<float> out);

/// Writes flames up to the distance at which they fade out as grids of a VDB file:
/// - `flames`: extinction in visible light, 1/m, as `march` draws them;
/// - `infrared`: extinction in the infrared, 1/m, as `march_infrared` draws them;
/// - `temperature`: K.
///
/// Values are computed on demand, leaf by leaf. Memory is needed for 76 bytes per leaf of 8^3
/// voxels with flames.
/// @throws std::invalid_argument if the voxel size is out of range
/// @throws Error if there are more leaves than memory could hold
/// @throws InputError if the file cannot be written
VdbSummary write_flames(const std::filesystem::path& path, const flames::FlameVolume& flames,
                        double voxel_size, const io::Metadata& metadata);

} // namespace firetwin::volume
