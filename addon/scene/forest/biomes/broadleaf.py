"""temperate broad-leaved forest of oak, beech, maple and some pine, with autumn colours by date."""

from .. import models
from ._biome import Biome, Land, OpenLand, Plants, Season, Species
from ._ecoregions import BROADLEAF, DESERT, NEARCTIC, STEPPE


def _suits(land: Land) -> float:
    realm, zone = land.ecoregion
    elsewhere = zone == STEPPE or (zone == DESERT and realm != NEARCTIC)
    return (zone == BROADLEAF) * (0.05 + land.wood) + elsewhere * 0.8 * land.wood


BIOME = Biome(
    suits=_suits,
    season=Season(peak=150.0, lasts=135.0, low=0.15),
    needles=((0.026, 0.046, 0.012), (0.070, 0.104, 0.030)),
    stands=(0.056, 0.074, 0.024),
    shade=(0.010, 0.018, 0.007),
    between=(0.014, 0.020, 0.009),
    crown=9.5,
    leaf_fall="winter",
    deciduous=0.85,
    withered=(3.0, 1.3, 1.1),
    litter=((0.040, 0.026, 0.014), (0.135, 0.088, 0.048)),
    scrub=(0.030, 0.046, 0.016),
    grass=((0.190, 0.150, 0.078), (0.056, 0.080, 0.026)),
    species=(
        Species(models.BEECHES, 0.40, height=0.74, width=1.05),
        Species(models.OAKS, 0.25, height=0.58, width=0.95),
        Species(models.MAPLES, 0.22, height=0.72, width=1.05),
        Species(models.PINES, 0.13, height=0.78, width=1.0),
    ),
    tree_cover=0.010,
    shrub_cover=0.10,
    shrub_load=(0.7, 1.6),
    open_land=OpenLand(
        bleached=(0.158, 0.130, 0.070),
        straw=(0.112, 0.090, 0.045),
        stale=(0.066, 0.054, 0.028),
        green=(0.050, 0.066, 0.023),
        lush=(0.032, 0.052, 0.016),
        soil=((0.066, 0.050, 0.034), (0.135, 0.103, 0.071)),
        shrub=((0.012, 0.020, 0.007), (0.040, 0.056, 0.020)),
        bare=0.06,
        bush=3.6,
        tussock=0.8,
        hollows=0.6,
        patch=600.0,
        tracks=900.0,
        draws=600.0,
    ),
    rock=(0.80, 0.78, 0.74),
    outcrops=0.15,
    plants=Plants(
        density={"brush": 0.7, "tuft": 0.8, "log": 1.0, "twigs": 1.0, "rock": 0.4},
        height={"brush": 1.2, "tuft": 1.1},
        width={"tuft": 1.6},
    ),
)
