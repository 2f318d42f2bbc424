"""tropical forest: tall evergreen crowns of many greens, with single giants above."""

from .. import models
from ._biome import Biome, Land, OpenLand, Plants, Season, Species
from ._ecoregions import RAINFOREST


def _suits(land: Land) -> float:
    return (land.ecoregion.zone == RAINFOREST) * (0.06 + 1.2 * land.wood)


BIOME = Biome(
    suits=_suits,
    season=Season(peak=150.0, lasts=130.0, low=0.30),
    needles=((0.018, 0.036, 0.010), (0.058, 0.094, 0.028)),
    stands=(0.060, 0.076, 0.026),
    shade=(0.007, 0.014, 0.006),
    between=(0.008, 0.014, 0.006),
    crown=12.0,
    litter=((0.034, 0.024, 0.014), (0.100, 0.070, 0.042)),
    scrub=(0.022, 0.044, 0.012),
    grass=((0.170, 0.130, 0.064), (0.056, 0.084, 0.026)),
    species=(
        Species(models.RAINFOREST_TREES[:2], 0.88, height=0.86, width=1.15),
        Species(models.RAINFOREST_TREES[2:], 0.12, height=1.08, width=1.3),
    ),
    tree_cover=0.015,
    shrub_cover=0.20,
    shrub_load=(0.6, 1.6),
    open_land=OpenLand(
        bleached=(0.150, 0.116, 0.056),
        straw=(0.108, 0.080, 0.036),
        stale=(0.060, 0.044, 0.022),
        green=(0.046, 0.068, 0.021),
        lush=(0.030, 0.052, 0.015),
        soil=((0.100, 0.052, 0.030), (0.180, 0.105, 0.062)),
        shrub=((0.010, 0.020, 0.006), (0.038, 0.058, 0.018)),
        bare=0.06,
        bush=4.0,
        hollows=0.5,
        patch=700.0,
        tracks=1600.0,
    ),
    rock=(0.80, 0.72, 0.60),
    outcrops=0.0,
    plants=Plants(
        density={"brush": 1.2, "tuft": 0.7, "log": 0.8, "twigs": 0.8, "rock": 0.1},
        height={"brush": 1.8, "tuft": 1.4},
    ),
)
