#pragma once

/// Allometry: stem density, diameters, heights and crowns of a stand from its canopy fuel load.
namespace firetwin::forest {

constexpr double min_canopy_fuel = 0.01;  ///< kg/m2; no trees up to this load (Algorithm 2)
constexpr double max_stem_density = 0.09; ///< stems per m2

/// Stems per m2 of a closed or open stand with this canopy fuel load W (kg/m2), at most
/// `max_stem_density`; 0 up to `min_canopy_fuel` and if W is not finite.
///
/// Cruz, Alexander and Wakimoto (2003, Int. J. Wildland Fire 12:39-50), mixed conifer, of basal
/// area B (m2/ha) and stems N (1/ha): ln W = -4.824 + 0.804 ln B + 0.333 ln N, solved for N with
/// B = N pi/4 D^2 and the quadratic mean diameter `mean_diameter(W)`:  N = 453 W^0.53.
double stems(double canopy_fuel);

/// Quadratic mean diameter at breast height, m: 0.30 W^(1/4). An assumption that Cruz's equation
/// needs: stands with more fuel are both denser and larger.
double mean_diameter(double canopy_fuel);

/// Height (m) of a tree by its rank in the stand: the share (0, 1] of trees at least as large.
///
/// Diameters are exponentially distributed from 5 cm up (uneven-aged stands: de Liocourt 1898,
/// Meyer 1952) with the quadratic mean above; heights follow from the Western Sierra variant of the
/// Forest Vegetation Simulator (Wykoff's form, the same for sugar and ponderosa pine, white and red
/// fir and incense cedar): feet = 4.5 + exp(4.86039 - 9.32795 / (inches + 1)). Between 3.1 and 41
/// m.
double height(double canopy_fuel, double rank);

/// Crown widening of a thinned stand: factor on crown widths that conserves the summed crown area.
/// Crown area is proportional to the square of tree height. The retained share (0, 1] of the stems
/// has mostly large trees.
double crown_widening(double canopy_fuel, double retained);

} // namespace firetwin::forest
