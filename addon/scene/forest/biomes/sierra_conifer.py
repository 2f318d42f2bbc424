"""mixed conifers of the Sierra Nevada and of western North America, oaks in the foothills."""

from ._biome import Biome, Land, Season
from ._ecoregions import CONIFER, DESERT, MEDITERRANEAN, NEARCTIC


def _suits(land: Land) -> float:
    realm, zone = land.ecoregion
    return (realm == NEARCTIC and zone in (CONIFER, MEDITERRANEAN, DESERT)) * (0.05 + land.wood)


BIOME = Biome(
    suits=_suits,
    season=Season(peak=135.0, lasts=80.0),
    needles=((0.026, 0.043, 0.016), (0.072, 0.092, 0.036)),
    stands=(0.034, 0.072, 0.026),
    shade=(0.009, 0.014, 0.008),
    between=(0.010, 0.015, 0.008),
    leaf_fall="winter",
)
