"""Exposure of a sample: automatic exposures rise in the dark, within a limit, and err. Needs no Blender."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

MOST = 5.0
"""Stops at most that the exposure rises above the film's (assumed)."""
_SHOWN = 0.03  # luminance of a picture, relative to white, up to which the exposure rises (by eye)
_LIGHTS, _WHITE = 99.8, 1.5  # percentile of luminance that stays below this share of white (by eye)
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
_LEAST = 1.0e-7


def rise(light: NDArray, exposure: float) -> float:
    """Compute by how many stops the exposure of a radiance (h, w, 3) rises above `exposure`, 0 to `MOST`.

    The geometric mean of luminance becomes `_SHOWN`, unless lamps or flames would become too bright.
    """
    shown = np.maximum(light @ _LUMINANCE, _LEAST) * 2.0**exposure
    wanted = np.log2(_SHOWN) - float(np.log2(shown).mean())
    limit = np.log2(_WHITE / float(np.percentile(shown, _LIGHTS)))
    return float(np.clip(min(wanted, limit), 0.0, MOST))
