#pragma once

#include "tiles/matrix.hpp"
#include "tiles/tables.hpp"

#include <string>
#include <vector>

namespace firetwin::tiles {

/// Instance matrices of an i3dm in the content's frame, RTC_CENTER included.
/// @param to_earth from the content's frame to Earth-centred metres, for EAST_NORTH_UP
/// @throws InputError
std::vector<Matrix> read_instances(const FeatureTable& table, const Matrix& to_earth);

/// The uri of an i3dm's glTF, which follows its tables and is padded with spaces or zeros.
std::string read_model_uri(const Sections& sections);

} // namespace firetwin::tiles
