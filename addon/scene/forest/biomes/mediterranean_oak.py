"""Mediterranean woodland of holm and cork oak: low, round, dark crowns above scrub, with some pines."""

from .. import models
from ._biome import Biome, Land, OpenLand, Plants, Season, Species
from ._ecoregions import DESERT, MEDITERRANEAN, NEARCTIC


def _suits(land: Land) -> float:
    realm, zone = land.ecoregion
    dry = zone == MEDITERRANEAN or (zone == DESERT and land.latitude > 28.0)
    return land.wood * (realm != NEARCTIC) * dry


BIOME = Biome(
    suits=_suits,
    season=Season(peak=95.0, lasts=72.0, low=0.05),
    needles=((0.022, 0.030, 0.013), (0.056, 0.066, 0.032)),
    stands=(0.058, 0.064, 0.034),
    shade=(0.009, 0.012, 0.007),
    between=(0.032, 0.026, 0.016),
    crown=7.0,
    litter=((0.044, 0.032, 0.020), (0.120, 0.088, 0.056)),
    scrub=(0.028, 0.036, 0.017),
    grass=((0.215, 0.165, 0.084), (0.062, 0.072, 0.027)),
    species=(
        Species(models.HOLM_OAKS, 0.74, height=0.46, width=1.05),
        Species(models.LIVE_OAKS, 0.12, height=0.42, width=0.95),
        Species(models.STONE_PINES, 0.14, height=0.66, width=0.95),
    ),
    tree_cover=0.045,
    shrub_cover=0.22,
    shrub_load=(0.45, 1.4),
    open_land=OpenLand(
        bleached=(0.168, 0.134, 0.076),
        straw=(0.118, 0.090, 0.046),
        stale=(0.074, 0.057, 0.032),
        green=(0.056, 0.066, 0.025),
        lush=(0.046, 0.066, 0.022),
        soil=((0.105, 0.070, 0.045), (0.195, 0.150, 0.105)),
        shrub=((0.010, 0.015, 0.007), (0.035, 0.041, 0.020)),
        bare=0.20,
        bush=3.2,
        hollows=0.6,
        patch=500.0,
        tracks=700.0,
        draws=500.0,
    ),
    rock=(1.25, 1.16, 1.02),
    outcrops=0.5,
    plants=Plants(
        density={"brush": 2.0, "tuft": 0.7, "log": 0.3, "twigs": 0.5, "rock": 1.2},
        height={"brush": 1.2},
        models={"brush": (models.MAQUIS, models.BURNED_MAQUIS)},
    ),
)
