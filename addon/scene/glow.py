"""Emission of billboards, embers, trees and firebrands. For marched flames see `fire.flame_volume`."""

from __future__ import annotations

from ..shot.light import exposure
from ..shot.shot import Shot

FLAME = (1.0, 0.33, 0.04)
RIM, BODY, CORE = (1.0, 0.12, 0.008), (1.0, 0.34, 0.04), (1.0, 0.55, 0.15)
"""Colours of a flame, from its coolest part to its hottest."""
EMBER = (1.0, 0.11, 0.012)
CLOSE = 200.0, 2500.0  # m from the camera: overexposure limit close by, visibility far away
FLAMING_TIME = 100.0, 300.0  # s that the front in timber flames, for distances close by and at FAR
FAR = 9000.0  # m; from there on the drawn front is wider, as a picture's pixels are
_LIGHT = 13.0  # radiance of flames at exposure 0


def brightness(shot: Shot) -> float:
    """Return the radiance of flames: lower in longer exposures, which limits clipping (smaller aperture)."""
    return _LIGHT * dimming(exposure.middle(shot))


def dimming(stops: float) -> float:
    """Return the factor on the radiance of fire at an exposure (stops)."""
    return float(2.0 ** (-0.85 * stops))
