"""mixed conifers of the Sierra Nevada and of western North America, oaks in the foothills."""

from ._biome import Biome, Land, Season
from ._ecoregions import CONIFER, DESERT, MEDITERRANEAN, NEARCTIC


def _suits(land: Land) -> float:
    realm, zone = land.ecoregion
    return (realm == NEARCTIC and zone in (CONIFER, MEDITERRANEAN, DESERT)) * (0.05 + land.wood)


BIOME = Biome(
    suits=_suits,
    season=Season(peak=135.0, lasts=80.0),
    needles=((0.021, 0.026, 0.006), (0.057, 0.056, 0.012)),
    stands=(0.029, 0.035, 0.008),
    shade=(0.009, 0.012, 0.006),
    between=(0.010, 0.012, 0.005),
    leaf_fall="winter",
)
