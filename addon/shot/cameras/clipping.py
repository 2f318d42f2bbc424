"""Clip planes of cameras that change height by orders of magnitude, for every frame.

Near and far follow the nearest and farthest visible object, so that their ratio, which decides the
precision of a depth buffer, is as small as that allows. Both are continuous in the height.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from firetwin_core import constants, geo
from numpy.typing import NDArray

from ..terrain import noise

if TYPE_CHECKING:
    from ..terrain.terrain import Terrain

Array = NDArray[np.float64]

NEAREST = 0.5  # m
HIGHEST_AIR = 20_000.0  # m, above any smoke
_AMID, _ABOVE = 0.01, 0.35  # parts of the height over the highest ground: amid smoke, and above all air
_SPACE = 80_000.0  # m, height from which the latter holds
_LOWEST = 12_000.0  # m below the ellipsoid; nothing is lower
_SPARE = 1.05


def planes(position: Array, ground: Terrain) -> Array:
    """Near and far planes (frames, 2), m, of a camera at places (frames, 3) of the scene.

    Near is a part of the height over the highest ground: a hundredth amid the air over the fire, where only
    smoke and sparks are nearer, and more above it, but never within it (`HIGHEST_AIR`). Far is beyond the
    horizon, behind which that air is still seen.
    """
    height = heights(ground.frame, position)
    over = height - float(ground.fields.elevation.max())
    near = over * (_AMID + (_ABOVE - _AMID) * noise.smoothstep(HIGHEST_AIR, _SPACE, height))
    near = np.maximum(near, NEAREST)
    return np.stack([near, _SPARE * (horizon(height) + horizon(HIGHEST_AIR))], axis=-1)


def heights(frame: geo.LocalFrame, position: Array) -> Array:
    """Heights (n,) above the ellipsoid, m, of places (n, 3)."""
    return np.asarray(frame.reverse(position)[2])


def horizon(height: Array | float) -> Array:
    """Distance (n,) of the horizon from a height (n,), m; of the least low ground from below it."""
    above = np.maximum(np.asarray(height, np.float64), 0.0) + _LOWEST
    return np.sqrt(above * (2.0 * constants.SEMI_MAJOR_AXIS + above))
