"""green fields with hedges, tracks and single trees; all of them are invented."""

from .. import models
from ._biome import Biome, Land, OpenLand, Plants, Season, Species


def _suits(land: Land) -> float:
    europe, zealand = land.within(43.5, 61.0, -11.0, 25.0), land.within(-47.5, -34.0, 166.0, 179.5)
    return land.grass * (1.0 if europe or zealand else 0.2)


BIOME = Biome(
    suits=_suits,
    season=Season(peak=150.0, lasts=150.0, low=0.35),
    needles=((0.024, 0.042, 0.014), (0.062, 0.088, 0.030)),
    stands=(0.048, 0.078, 0.026),
    shade=(0.010, 0.016, 0.008),
    between=(0.014, 0.020, 0.009),
    crown=9.0,
    leaf_fall="winter",
    deciduous=0.8,
    withered=(1.7, 1.1, 0.7),
    litter=((0.030, 0.026, 0.014), (0.090, 0.074, 0.042)),
    scrub=(0.028, 0.044, 0.014),
    grass=((0.150, 0.128, 0.062), (0.052, 0.072, 0.024)),
    species=(
        Species(models.BEECHES, 0.45, height=0.60),
        Species(models.OAKS, 0.35, height=0.55),
        Species(models.BIRCHES, 0.20, height=0.55),
    ),
    tree_cover=0.004,
    shrub_cover=0.0,
    shrub_load=(1.0, 2.0),
    open_land=OpenLand(
        bleached=(0.128, 0.112, 0.058),
        straw=(0.092, 0.084, 0.040),
        stale=(0.062, 0.056, 0.027),
        green=(0.044, 0.059, 0.021),
        lush=(0.029, 0.045, 0.015),
        soil=((0.066, 0.050, 0.034), (0.135, 0.103, 0.071)),
        shrub=((0.010, 0.017, 0.006), (0.030, 0.042, 0.015)),
        bare=0.02,
        bush=4.0,
        tussock=0.7,
        hollows=0.4,
        patch=700.0,
        tracks=520.0,
        field=(230.0, 160.0),
        hedge=6.0,
        tilled=1.0,
    ),
    outcrops=0.0,
    plants=Plants(
        density={"brush": 0.05, "tuft": 2.2, "log": 0.02, "twigs": 0.05, "rock": 0.05},
        height={"tuft": 0.7, "brush": 1.6},
        width={"tuft": 2.4},
        finer={"tuft": 1.5},
    ),
)
