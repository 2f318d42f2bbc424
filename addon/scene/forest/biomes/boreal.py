"""spruce, pine, larch and birch of the north, moss, lichen and bogs."""

from .. import models
from ._biome import Biome, Land, OpenLand, Plants, Season, Species
from ._ecoregions import BOREAL, CONIFER, NEARCTIC, STEPPE, TUNDRA


def _suits(land: Land) -> float:
    realm, zone = land.ecoregion
    north = zone in (BOREAL, TUNDRA)
    mountains = zone == CONIFER and realm != NEARCTIC
    cold_steppe = zone == STEPPE and land.latitude > 48.0
    return (0.05 + land.wood + 0.4 * (land.shrub + land.grass)) * north + 0.95 * land.wood * (
        mountains or cold_steppe
    )


BIOME = Biome(
    suits=_suits,
    season=Season(peak=190.0, lasts=80.0, low=0.15),
    needles=((0.016, 0.028, 0.014), (0.046, 0.062, 0.030)),
    stands=(0.052, 0.082, 0.030),
    shade=(0.007, 0.011, 0.007),
    between=(0.022, 0.024, 0.013),
    crown=6.0,
    leaf_fall="winter",
    deciduous=0.30,
    withered=(3.6, 2.0, 1.0),
    litter=((0.030, 0.032, 0.016), (0.092, 0.092, 0.058)),
    scrub=(0.034, 0.050, 0.018),
    grass=((0.150, 0.125, 0.065), (0.060, 0.080, 0.026)),
    species=(
        Species(models.SPRUCES, 0.50, height=0.66, width=0.85),
        Species(models.BIRCHES, 0.18, height=0.60, width=1.0),
        Species(models.PINES, 0.18, height=0.70, width=0.85),
        Species(models.LARCHES, 0.14, height=0.68, width=0.90),
    ),
    tree_cover=0.012,
    shrub_cover=0.22,
    shrub_load=(0.5, 1.6),
    open_land=OpenLand(
        bleached=(0.128, 0.124, 0.090),
        straw=(0.082, 0.069, 0.036),
        stale=(0.060, 0.045, 0.027),
        green=(0.043, 0.054, 0.021),
        lush=(0.028, 0.042, 0.015),
        soil=((0.040, 0.032, 0.024), (0.110, 0.092, 0.070)),
        shrub=((0.020, 0.030, 0.012), (0.054, 0.066, 0.026)),
        bare=0.05,
        bush=2.4,
        tussock=0.8,
        hollows=0.7,
        patch=450.0,
        draws=420.0,
    ),
    rock=(0.72, 0.72, 0.75),
    outcrops=0.35,
    plants=Plants(
        density={"brush": 0.9, "tuft": 0.7, "log": 1.4, "rock": 0.6},
        height={"brush": 0.7, "tuft": 0.8},
    ),
)
