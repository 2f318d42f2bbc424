#pragma once

/// Allometry: stem density, diameters, heights and crowns of a stand from its canopy fuel load.
namespace firetwin::forest {

constexpr double least_canopy_fuel = 0.01; ///< kg/m2; below it nothing stands (Algorithm 2)
constexpr double most_stems = 0.09;        ///< per m2

/// Stems per m2 of a closed or open stand with this canopy fuel load W (kg/m2), at most
/// `most_stems`; 0 from `least_canopy_fuel` down and where W is not finite.
///
/// Cruz, Alexander and Wakimoto (2003, Int. J. Wildland Fire 12:39-50), mixed conifer, of basal
/// area B (m2/ha) and stems N (1/ha): ln W = -4.824 + 0.804 ln B + 0.333 ln N, solved for N with
/// B = N pi/4 D^2 and the quadratic mean diameter `mean_diameter(W)`:  N = 453 W^0.53.
double stems(double canopy_fuel);

/// Quadratic mean diameter at breast height, m: 0.30 W^(1/4). Assumed: fuel says nothing of it, but
/// Cruz's equation wants it; stands with more fuel are both denser and larger.
double mean_diameter(double canopy_fuel);

/// Height (m) of a tree by its rank in the stand: the share (0, 1] of trees at least as large.
///
/// Diameters fall off exponentially from 5 cm up, many small and few large (de Liocourt 1898, Meyer
/// 1952: stands of all ages), to the mean square above; heights follow from them as in the Forest
/// Vegetation Simulator's Western Sierra variant (Wykoff's form, the same for sugar and ponderosa
/// pine, white and red fir and incense cedar): feet = 4.5 + exp(4.86039 - 9.32795 / (inches + 1)).
/// Between 3.1 and 41 m.
double height(double canopy_fuel, double rank);

/// Crown widening of a thinned stand: factor on crown widths that conserves the summed crown area.
/// A crown's area goes with the square of its tree's height. The share `retained` (0, 1] of the
/// stems is mostly of large trees.
double crown_widening(double canopy_fuel, double retained);

} // namespace firetwin::forest
