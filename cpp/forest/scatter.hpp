#pragma once

#include "base/buffer.hpp"
#include "forest/planting_site.hpp"

#include <cstdint>
#include <span>

namespace firetwin::forest {

enum SizeClass : std::uint8_t { small_tree = 0, medium_tree = 1, large_tree = 2 };

/// How many models a class has.
int models(SizeClass kind);

/// n trees in order of their cells; grass leaves size_class and model empty.
struct Plants {
  Buffer<std::int64_t> cell; ///< y fx + x
  Buffer<double> position;   ///< [3 n] m
  Buffer<std::uint8_t> size_class;
  Buffer<std::uint8_t> model; ///< 0..1 for large trees, 0..3 for the others
  Buffer<float> scale;        ///< height in m: the models are one metre tall
  Buffer<float> rotation;     ///< radians about the vertical
};

/// The largest finite fuel, 0 where there is none.
float largest_fuel(std::span<const float> fuel);

/// Algorithm 2 of the FIRETWIN paper: a tree in each cell with canopy fuel above 0.01 kg/m2.
///   fuel >= 1.6: large, 2 models, m = U(1.1, 1.4); >= 0.8: medium, 4 models, m = U(0.9, 1.2);
///   else small, 4 models, m = U(0.7, 1.0)
///   scale = lerp(6, 18, clamp(fuel / max_fuel, 0, 1)) m U(0.8, 1.2)
/// Cells whose fuel or elevation is not finite have no tree, nor have those that the site's mask
/// leaves out; the others' are the same with any mask. The result does not depend on the number of
/// threads, and a changed fuel changes the tree of its own cell only (while max_fuel is the same).
/// @throws std::invalid_argument unless max_fuel > 0 and 0 <= jitter <= 1.
Plants trees(std::span<const float> canopy_fuel, const PlantingSite& site, double max_fuel);

/// Algorithm 2's grass: a clump of scale 1 in each cell with surface fuel above 0, at the place
/// where its tree stands or would stand, 0.70 m lower (the paper's 70 are Unreal centimetres).
Plants grass(std::span<const float> surface_fuel, const PlantingSite& site);

} // namespace firetwin::forest
