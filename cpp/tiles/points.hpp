#pragma once

#include "tiles/assembler.hpp"
#include "tiles/tables.hpp"

#include <memory>

namespace firetwin::tiles {

/// The points of a pnts in the content's frame, without its RTC_CENTER, compressed by Draco or not.
/// Colours are sRGB there, and linear here. Points that are not finite are left out and counted.
/// @throws InputError
std::shared_ptr<const Primitive> read_points(const FeatureTable& table, Assembler& assembler);

} // namespace firetwin::tiles
