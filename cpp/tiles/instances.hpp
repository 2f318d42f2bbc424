#pragma once

#include "tiles/matrix.hpp"
#include "tiles/tables.hpp"

#include <string>
#include <vector>

namespace firetwin::tiles {

/// Matrices of an i3dm's instances in the content's frame, with its RTC_CENTER.
/// @param to_earth the content's frame to the Earth-centred one, for EAST_NORTH_UP
/// @throws InputError
std::vector<Matrix> read_instances(const FeatureTable& table, const Matrix& to_earth);

/// The uri of an i3dm's glTF: what follows its tables, padded with blanks or zeros.
std::string read_model_uri(const Sections& sections);

} // namespace firetwin::tiles
