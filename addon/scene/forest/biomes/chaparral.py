"""dense brush on slopes, blue and live oaks on golden grass between."""

from .. import models
from ._biome import Biome, Land, OpenLand, Plants, Season, Species


def _suits(land: Land) -> float:
    return land.shrub * (1.0 if land.within(25.0, 45.0, -127.0, -98.0) else 0.75)


BIOME = Biome(
    suits=_suits,
    season=Season(peak=75.0, lasts=85.0),
    needles=((0.028, 0.036, 0.016), (0.066, 0.072, 0.034)),
    stands=(0.050, 0.058, 0.028),
    shade=(0.012, 0.015, 0.009),
    between=(0.024, 0.022, 0.013),
    crown=9.0,
    litter=((0.045, 0.035, 0.020), (0.115, 0.090, 0.052)),
    scrub=(0.032, 0.038, 0.018),
    grass=((0.230, 0.178, 0.086), (0.080, 0.096, 0.034)),
    leaf_fall="winter",
    species=(
        Species(models.LIVE_OAKS, 0.65, height=0.48),
        Species(models.OAKS, 0.35, height=0.50),
    ),
    tree_cover=0.045,
    shrub_cover=0.10,
    shrub_load=(0.6, 1.3),
    open_land=OpenLand(
        bleached=(0.172, 0.136, 0.074),
        straw=(0.122, 0.092, 0.046),
        stale=(0.070, 0.053, 0.028),
        green=(0.062, 0.074, 0.026),
        lush=(0.040, 0.056, 0.019),
        soil=((0.105, 0.072, 0.046), (0.195, 0.145, 0.096)),
        shrub=((0.011, 0.014, 0.007), (0.036, 0.037, 0.020)),
        bare=0.12,
        bush=4.0,
        hollows=0.9,
        patch=600.0,
        tracks=900.0,
        draws=600.0,
    ),
    rock=(0.95, 0.84, 0.70),
    outcrops=0.4,
    plants=Plants(
        density={"brush": 2.4, "tuft": 1.0, "log": 0.3, "twigs": 0.3},
        height={"brush": 1.7, "tuft": 1.2},
        width={"tuft": 2.0},
    ),
)
