"""eucalypt forest of Australia: pale trunks, open drooping crowns, strips of bark on dry ground."""

from .. import models
from ._biome import Biome, Land, OpenLand, Plants, Season, Species


def _suits(land: Land) -> float:
    return (0.06 + 1.15 * land.wood) * land.within(-45.0, -10.5, 112.0, 155.0)


BIOME = Biome(
    suits=_suits,
    season=Season(peak=75.0, lasts=80.0, low=0.06),
    needles=((0.044, 0.052, 0.028), (0.104, 0.112, 0.064)),
    stands=(0.098, 0.092, 0.050),
    shade=(0.018, 0.021, 0.013),
    between=(0.040, 0.032, 0.020),
    crown=9.0,
    litter=((0.060, 0.040, 0.024), (0.175, 0.125, 0.080)),
    scrub=(0.036, 0.044, 0.020),
    grass=((0.230, 0.178, 0.092), (0.070, 0.082, 0.034)),
    species=(
        Species(models.EUCALYPTS[:2], 0.62, height=0.88, width=1.05),
        Species(models.EUCALYPTS[2:], 0.38, height=0.80, width=1.0),
    ),
    tree_cover=0.020,
    shrub_cover=0.10,
    shrub_load=(0.7, 1.6),
    open_land=OpenLand(
        bleached=(0.180, 0.140, 0.074),
        straw=(0.130, 0.096, 0.047),
        stale=(0.072, 0.052, 0.027),
        green=(0.058, 0.068, 0.026),
        lush=(0.040, 0.054, 0.019),
        soil=((0.110, 0.066, 0.040), (0.190, 0.130, 0.086)),
        shrub=((0.016, 0.021, 0.010), (0.046, 0.052, 0.026)),
        bare=0.16,
        bush=3.4,
        hollows=0.7,
        patch=700.0,
        tracks=1100.0,
        draws=700.0,
    ),
    rock=(1.05, 0.90, 0.74),
    outcrops=0.15,
    plants=Plants(
        density={"brush": 0.6, "tuft": 1.0, "log": 1.3, "twigs": 2.4, "rock": 0.3},
        height={"brush": 1.4, "tuft": 1.2, "twigs": 1.3},
        width={"tuft": 1.6, "twigs": 1.2},
        models={"twigs": (models.BARK_STRIPS, models.BARK_STRIPS)},
    ),
)
