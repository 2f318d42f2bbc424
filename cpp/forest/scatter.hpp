#pragma once

#include "base/buffer.hpp"
#include "forest/planting_site.hpp"

#include <cstdint>
#include <span>

namespace firetwin::forest {

enum SizeClass : std::uint8_t { small_tree = 0, medium_tree = 1, large_tree = 2 };

/// Number of models of a size class.
int models(SizeClass kind);

/// n plants ordered by cell; size_class and model are empty for grass.
struct Plants {
  Buffer<std::int64_t> cell; ///< y fx + x
  Buffer<double> position;   ///< [3 n] m
  Buffer<std::uint8_t> size_class;
  Buffer<std::uint8_t> model; ///< 0..1 for large trees, 0..3 for the others
  Buffer<float> scale;        ///< height, m, because the models are one metre tall
  Buffer<float> rotation;     ///< radians about the vertical
};

/// Largest finite fuel load; 0 without one.
float largest_fuel(std::span<const float> fuel);

/// Algorithm 2 of the FIRETWIN paper: a tree in each cell with canopy fuel above 0.01 kg/m2.
///   fuel >= 1.6: large, 2 models, m = U(1.1, 1.4); >= 0.8: medium, 4 models, m = U(0.9, 1.2);
///   else small, 4 models, m = U(0.7, 1.0)
///   scale = lerp(6, 18, clamp(fuel / max_fuel, 0, 1)) m U(0.8, 1.2)
/// Cells with fuel or elevation that is not finite and cells outside the mask have no tree; the
/// mask does not affect other cells. The result does not depend on the number of threads, and the
/// fuel of a cell affects only its own tree (for constant max_fuel).
/// @throws std::invalid_argument unless max_fuel > 0 and 0 <= jitter <= 1
Plants trees(std::span<const float> canopy_fuel, const PlantingSite& site, double max_fuel);

/// Grass of Algorithm 2: a clump of scale 1 in each cell with surface fuel above 0, 0.70 m below
/// the position of the cell's tree (the paper's offset of 70 is in Unreal centimetres).
Plants grass(std::span<const float> surface_fuel, const PlantingSite& site);

} // namespace firetwin::forest
