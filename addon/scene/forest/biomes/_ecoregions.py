"""Ecoregions of the world: realm and zone of a place, from a table of boxes.

Realms and zones follow D. M. Olson et al. (2001, "Terrestrial ecoregions of the world: a new map of life on
Earth", BioScience 51(11), 933-938), joined to ten zones. The boxes are drawn by hand, to about two degrees;
the first box that contains a place counts.
"""

from __future__ import annotations

from typing import NamedTuple

NEARCTIC, NEOTROPIC, PALEARCTIC = "nearctic", "neotropic", "palearctic"
AFROTROPIC, INDOMALAYA, AUSTRALASIA = "afrotropic", "indomalaya", "australasia"

TUNDRA, BOREAL, CONIFER, BROADLEAF = "tundra", "boreal", "temperate conifer", "temperate broadleaf"
MEDITERRANEAN, STEPPE, DESERT = "mediterranean", "temperate grassland", "desert"
SAVANNA, DRY_FOREST, RAINFOREST = "tropical savanna", "tropical dry forest", "tropical moist forest"


class Ecoregion(NamedTuple):
    """Realm and zone of a place, each one of the names above."""

    realm: str
    zone: str


Box = tuple[str, float, float, float, float]  # zone; south, north, west, east, degrees

_BOXES: dict[str, tuple[Box, ...]] = {
    NEARCTIC: (
        (TUNDRA, 69.0, 84.0, -170.0, -15.0),
        (CONIFER, 49.0, 60.0, -141.0, -119.0),  # coast and interior of British Columbia
        (CONIFER, 49.0, 53.0, -119.0, -114.0),
        (STEPPE, 49.0, 53.0, -114.0, -97.0),
        (BOREAL, 53.0, 69.0, -170.0, -97.0),
        (BOREAL, 49.0, 69.0, -97.0, -52.0),
        (MEDITERRANEAN, 30.0, 35.4, -121.5, -115.5),
        (MEDITERRANEAN, 35.4, 40.5, -124.5, -121.2),
        (CONIFER, 31.0, 49.0, -125.0, -103.0),
        (STEPPE, 29.0, 49.0, -103.0, -96.0),
        (BROADLEAF, 25.5, 49.0, -96.0, -52.0),
        (DESERT, 22.0, 31.0, -118.0, -109.0),
        (CONIFER, 17.0, 31.0, -109.0, -99.5),  # pine and oak of the Sierra Madre
        (DESERT, 22.0, 29.0, -99.5, -96.0),
    ),
    NEOTROPIC: (
        (DRY_FOREST, 17.0, 25.5, -99.5, -60.0),
        (RAINFOREST, 7.0, 17.0, -99.5, -77.0),
        (SAVANNA, 3.5, 10.0, -73.0, -61.0),  # Llanos
        (STEPPE, -28.0, -13.0, -72.0, -65.0),  # puna
        (RAINFOREST, -10.0, 8.0, -80.0, -49.0),  # Amazon
        (RAINFOREST, -15.0, -10.0, -77.0, -61.0),
        (DRY_FOREST, -15.0, -3.0, -45.0, -35.5),  # Caatinga
        (SAVANNA, -24.0, -3.0, -61.0, -43.5),  # Cerrado, Pantanal
        (SAVANNA, -33.0, -16.0, -65.0, -57.0),  # Chaco
        (RAINFOREST, -30.0, -3.0, -57.0, -34.0),  # Atlantic forest
        (MEDITERRANEAN, -38.0, -30.0, -74.0, -69.8),
        (BROADLEAF, -56.0, -38.0, -76.0, -71.0),  # Valdivian and Magellanic forest
        (DESERT, -40.0, -24.0, -70.0, -65.0),
        (DESERT, -30.0, -5.0, -82.0, -69.0),
        (STEPPE, -56.0, -29.0, -71.0, -49.0),  # pampas, Patagonia
    ),
    PALEARCTIC: (
        (TUNDRA, 70.5, 84.0, -12.0, 180.0),
        (BOREAL, 62.0, 67.0, -25.0, -12.0),
        (BOREAL, 59.5, 70.5, 4.0, 32.0),
        (BOREAL, 57.0, 70.5, 32.0, 60.0),
        (BOREAL, 54.5, 70.5, 60.0, 180.0),
        (BOREAL, 49.5, 54.5, 98.0, 145.0),
        (CONIFER, 48.0, 54.5, 84.0, 98.0),  # Altai and Sayan
        (CONIFER, 45.8, 47.8, 6.0, 14.5),  # Alps
        (MEDITERRANEAN, 27.0, 33.5, -18.5, -13.0),  # Canary Islands, Madeira
        (MEDITERRANEAN, 36.0, 42.5, -10.0, 3.4),
        (MEDITERRANEAN, 42.3, 44.3, 2.6, 7.8),
        (MEDITERRANEAN, 35.5, 44.2, 7.8, 12.0),
        (MEDITERRANEAN, 35.5, 42.5, 12.0, 20.5),
        (MEDITERRANEAN, 42.5, 45.3, 13.4, 17.0),
        (MEDITERRANEAN, 34.0, 41.3, 20.5, 31.0),
        (MEDITERRANEAN, 31.0, 37.5, 31.0, 37.0),
        (MEDITERRANEAN, 30.5, 37.4, -10.0, 11.5),
        (STEPPE, 46.0, 54.5, 31.0, 84.0),
        (STEPPE, 43.0, 51.0, 98.0, 120.0),
        (CONIFER, 28.0, 36.5, 72.5, 104.0),  # Himalaya, Hengduan
        (DESERT, 16.0, 36.0, -18.0, 62.0),
        (DESERT, 36.0, 49.0, 48.0, 106.0),
        (BROADLEAF, 36.0, 60.0, -12.0, 62.0),
        (BROADLEAF, 25.0, 55.0, 98.0, 150.0),
    ),
    AFROTROPIC: (
        (MEDITERRANEAN, -35.0, -32.0, 17.5, 26.5),  # Cape
        (RAINFOREST, -5.0, 5.0, 8.0, 30.0),
        (RAINFOREST, 4.0, 8.0, -14.0, 8.0),
        (RAINFOREST, -25.5, -12.0, 47.3, 51.0),
        (STEPPE, -32.0, -25.5, 25.5, 31.5),  # Highveld
        (DESERT, -32.0, -16.0, 11.0, 20.0),
        (DESERT, 2.0, 16.0, 42.0, 52.0),
        (SAVANNA, -35.0, 16.0, -18.0, 52.0),
    ),
    INDOMALAYA: (
        (DESERT, 23.0, 32.0, 62.0, 74.0),
        (RAINFOREST, 8.0, 20.0, 72.5, 76.5),  # Western Ghats
        (DRY_FOREST, 5.0, 28.0, 70.0, 88.0),
        (DRY_FOREST, 12.0, 21.0, 94.5, 106.5),
        (RAINFOREST, -11.0, 28.0, 88.0, 130.0),
    ),
    AUSTRALASIA: (
        (RAINFOREST, -11.0, 0.0, 130.0, 170.0),
        (SAVANNA, -20.0, -10.0, 112.0, 148.0),
        (MEDITERRANEAN, -36.0, -27.0, 112.0, 125.0),
        (MEDITERRANEAN, -39.0, -33.0, 133.0, 143.0),
        (BROADLEAF, -45.0, -24.0, 146.5, 155.0),
        (BROADLEAF, -45.0, -36.0, 140.5, 155.0),
        (STEPPE, -36.0, -20.0, 141.0, 150.0),
        (DESERT, -34.0, -20.0, 112.0, 141.0),
        (BROADLEAF, -48.0, -34.0, 166.0, 180.0),
    ),
}


def at(latitude: float, longitude: float) -> Ecoregion:
    """Look up the ecoregion of a place, degrees; in no box, a zone by latitude and a realm by longitude."""
    east = (longitude + 180.0) % 360.0 - 180.0
    for realm, boxes in _BOXES.items():
        for zone, south, north, west, most in boxes:
            if south <= latitude < north and west <= east < most:
                return Ecoregion(realm, zone)
    return Ecoregion(_realm(latitude, east), _zone(abs(latitude)))


def _zone(off: float) -> str:
    """Zone at `off` degrees from the equator."""
    for limit, zone in ((23.0, SAVANNA), (52.0, BROADLEAF), (66.0, BOREAL)):
        if off < limit:
            return zone
    return TUNDRA


def _realm(latitude: float, longitude: float) -> str:
    """Realm of the continent at this longitude."""
    if longitude < -30.0:
        return NEARCTIC if latitude > 20.0 else NEOTROPIC
    if latitude > 26.0:
        return PALEARCTIC
    if longitude < 60.0:
        return AFROTROPIC
    return AUSTRALASIA if latitude < -11.0 or longitude > 130.0 else INDOMALAYA
