"""Mediterranean scrub of evergreen bushes, with holm oaks and pines."""

from .. import models
from ._biome import Biome, Land, OpenLand, Plants, Season, Species
from ._ecoregions import MEDITERRANEAN, NEARCTIC


def _suits(land: Land) -> float:
    realm, zone = land.ecoregion
    basin = zone == MEDITERRANEAN and realm != NEARCTIC
    return 0.05 * basin + land.shrub * (1.0 if basin else 0.7)


BIOME = Biome(
    suits=_suits,
    season=Season(peak=110.0, lasts=95.0, low=0.05),
    needles=((0.024, 0.036, 0.015), (0.064, 0.078, 0.036)),
    stands=(0.046, 0.058, 0.030),
    shade=(0.011, 0.015, 0.009),
    between=(0.020, 0.020, 0.012),
    crown=7.5,
    litter=((0.040, 0.030, 0.018), (0.100, 0.078, 0.050)),
    scrub=(0.030, 0.040, 0.018),
    grass=((0.145, 0.114, 0.060), (0.060, 0.069, 0.026)),
    species=(
        Species(models.HOLM_OAKS, 0.6, height=0.40, width=1.0),
        Species(models.STONE_PINES, 0.4, height=0.62, width=1.0),
    ),
    tree_cover=0.012,
    shrub_cover=0.30,
    shrub_load=(0.35, 1.2),
    open_land=OpenLand(
        bleached=(0.148, 0.120, 0.072),
        straw=(0.098, 0.078, 0.043),
        stale=(0.072, 0.057, 0.033),
        green=(0.056, 0.065, 0.026),
        lush=(0.050, 0.070, 0.024),
        soil=((0.095, 0.064, 0.042), (0.185, 0.143, 0.102)),
        shrub=((0.009, 0.015, 0.006), (0.033, 0.039, 0.019)),
        bare=0.30,
        bush=3.4,
        hollows=0.6,
        patch=500.0,
        tracks=700.0,
        draws=500.0,
    ),
    rock=(1.30, 1.22, 1.08),
    outcrops=0.8,
    plants=Plants(
        density={"brush": 3.2, "tuft": 0.5, "log": 0.2, "twigs": 0.4, "rock": 1.6},
        height={"brush": 1.35},
        models={"brush": (models.MAQUIS, models.BURNED_MAQUIS)},
    ),
)
