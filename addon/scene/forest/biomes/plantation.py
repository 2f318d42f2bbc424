"""planted pines of one age in rows; never chosen by place, name it."""

from .. import models
from ._biome import Biome, Land, OpenLand, Plants, Season, Species


def _suits(land: Land) -> float:
    return -1.0


BIOME = Biome(
    suits=_suits,
    season=Season(peak=130.0, lasts=110.0, low=0.15),
    needles=((0.026, 0.044, 0.017), (0.060, 0.084, 0.034)),
    stands=(0.056, 0.074, 0.030),
    shade=(0.011, 0.016, 0.009),
    between=(0.022, 0.020, 0.012),
    crown=5.0,
    litter=((0.046, 0.028, 0.016), (0.130, 0.078, 0.042)),
    scrub=(0.032, 0.042, 0.018),
    species=(Species(models.CROP_PINES, 1.0, width=0.8),),
    rows=6.5,
    tree_cover=0.0,
    shrub_cover=0.10,
    open_land=OpenLand(
        bleached=(0.150, 0.122, 0.066),
        straw=(0.108, 0.086, 0.044),
        stale=(0.066, 0.052, 0.028),
        green=(0.050, 0.063, 0.023),
        lush=(0.035, 0.052, 0.018),
        soil=((0.080, 0.058, 0.040), (0.165, 0.130, 0.095)),
        shrub=((0.014, 0.020, 0.008), (0.040, 0.050, 0.020)),
        bare=0.10,
        bush=2.6,
        tussock=0.8,
        hollows=0.4,
        patch=600.0,
        tracks=600.0,
    ),
    rock=(0.85, 0.82, 0.76),
    outcrops=0.0,
    plants=Plants(density={"brush": 0.7, "tuft": 0.8, "log": 0.4, "twigs": 1.4, "rock": 0.1}),
)
