"""steppe and prairie: grass in patches, bushes and hardly a tree, tracks."""

from .. import models
from ._biome import Biome, Land, OpenLand, Plants, Season, Species
from ._ecoregions import DESERT, STEPPE


def _suits(land: Land) -> float:
    return 0.9 * land.grass + 0.05 * (land.ecoregion.zone in (STEPPE, DESERT))


BIOME = Biome(
    suits=_suits,
    season=Season(peak=150.0, lasts=85.0, low=0.08),
    needles=((0.030, 0.038, 0.017), (0.070, 0.078, 0.036)),
    stands=(0.050, 0.062, 0.028),
    shade=(0.013, 0.016, 0.010),
    between=(0.030, 0.028, 0.016),
    crown=8.0,
    litter=((0.050, 0.042, 0.024), (0.120, 0.098, 0.056)),
    scrub=(0.036, 0.042, 0.020),
    grass=((0.215, 0.168, 0.086), (0.080, 0.096, 0.036)),
    leaf_fall="winter",
    species=(
        Species(models.OAKS, 0.5, height=0.40),
        Species(models.LIVE_OAKS, 0.5, height=0.32),
    ),
    tree_cover=0.0035,
    shrub_cover=0.06,
    shrub_load=(0.9, 1.8),
    open_land=OpenLand(
        bleached=(0.158, 0.123, 0.062),
        straw=(0.108, 0.079, 0.034),
        stale=(0.056, 0.040, 0.020),
        green=(0.058, 0.066, 0.026),
        lush=(0.034, 0.048, 0.018),
        soil=((0.075, 0.054, 0.035), (0.150, 0.112, 0.072)),
        shrub=((0.016, 0.021, 0.010), (0.042, 0.046, 0.022)),
        bare=0.10,
        bush=3.6,
        tussock=1.0,
        hollows=0.8,
        patch=1100.0,
        tracks=650.0,
        field=(1150.0, 820.0),
        draws=820.0,
    ),
    rock=(1.25, 1.15, 1.0),
    outcrops=0.1,
    plants=Plants(
        density={"brush": 0.22, "tuft": 3.4, "log": 0.02, "twigs": 0.05, "rock": 0.25},
        height={"brush": 1.1, "tuft": 1.5},
        width={"tuft": 2.6},
        finer={"tuft": 1.5},
    ),
)
