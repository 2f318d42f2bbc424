"""Colour and brightness of what glows, as flames, ground, trees and firebrands share them."""

from __future__ import annotations

import numpy as np

from ..shot.light import exposure
from ..shot.shot import Shot

FLAME = (1.0, 0.33, 0.04)
EMBER = (1.0, 0.11, 0.012)
CLOSE = 200.0, 2500.0  # m from the camera: flames that fill pixels would burn out, afar they must show
FLAMING_TIME = 100.0, 300.0  # s that the edge of timber is in flames, seen from nearby and from FAR
FAR = 9000.0  # m; from there the edge is drawn wider, as a picture's pixels are
_LIGHT = 13.0  # radiance of flames at exposure 0


def brightness(shot: Shot) -> float:
    """Radiance of flames: less in a longer exposure, as a photographer stops down, else nights burn out."""
    stops = exposure.at(shot, np.array([0.5 * (1 + shot.frames.count)]))[0]
    return float(_LIGHT * 2.0 ** (-0.85 * stops))
