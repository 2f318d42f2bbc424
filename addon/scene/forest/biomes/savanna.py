"""tropical grass, dry for half of the year, with flat-topped trees and bushes."""

from .. import models
from ._biome import Biome, Land, OpenLand, Plants, Season, Species
from ._ecoregions import DRY_FOREST, RAINFOREST, SAVANNA


def _suits(land: Land) -> float:
    zone = land.ecoregion.zone
    tropics = zone in (SAVANNA, DRY_FOREST) or (zone == RAINFOREST and abs(land.latitude) < 20.0)
    return tropics * (0.05 + land.grass + 0.9 * land.shrub + 0.75 * land.wood)


BIOME = Biome(
    suits=_suits,
    season=Season(peak=230.0, lasts=110.0, low=0.05),
    needles=((0.026, 0.036, 0.014), (0.066, 0.076, 0.032)),
    stands=(0.048, 0.060, 0.024),
    shade=(0.012, 0.016, 0.009),
    between=(0.034, 0.028, 0.015),
    crown=10.0,
    leaf_fall="drought",
    deciduous=0.6,
    withered=(1.5, 1.1, 0.8),
    litter=((0.050, 0.036, 0.020), (0.125, 0.092, 0.052)),
    scrub=(0.036, 0.042, 0.018),
    grass=((0.215, 0.160, 0.074), (0.080, 0.096, 0.034)),
    species=(
        Species(models.ACACIAS, 0.7, height=0.62, width=1.0),
        Species(models.LIVE_OAKS, 0.3, height=0.55, width=0.9),
    ),
    tree_cover=0.05,
    shrub_cover=0.08,
    shrub_load=(0.6, 1.6),
    open_land=OpenLand(
        bleached=(0.160, 0.116, 0.052),
        straw=(0.112, 0.076, 0.030),
        stale=(0.060, 0.039, 0.018),
        green=(0.056, 0.066, 0.023),
        lush=(0.036, 0.052, 0.017),
        soil=((0.092, 0.048, 0.026), (0.165, 0.094, 0.052)),
        shrub=((0.014, 0.020, 0.008), (0.042, 0.047, 0.020)),
        bare=0.18,
        bush=4.2,
        tussock=1.1,
        hollows=0.8,
        patch=900.0,
        draws=1100.0,
        tracks=1400.0,
    ),
    rock=(0.95, 0.82, 0.68),
    outcrops=0.1,
    plants=Plants(
        density={"brush": 0.5, "tuft": 3.0, "log": 0.05, "twigs": 0.1, "rock": 0.3},
        height={"brush": 1.5, "tuft": 1.8},
        width={"tuft": 2.2},
        finer={"tuft": 1.5},
    ),
)
