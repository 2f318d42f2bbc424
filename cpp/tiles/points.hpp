#pragma once

#include "tiles/assembler.hpp"
#include "tiles/tables.hpp"

#include <memory>

namespace firetwin::tiles {

/// Reads the points of a pnts, plain or Draco-compressed, in the content's frame without
/// RTC_CENTER. Colours are converted from sRGB to linear. Points with NaN or infinite coordinates
/// are dropped and counted.
/// @throws InputError
std::shared_ptr<const Primitive> read_points(const FeatureTable& table, Assembler& assembler);

} // namespace firetwin::tiles
