"""Map of flame length over the ground, from which flames near a camera are drawn as a volume.

Needs no Blender.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from firetwin_core import constants
from firetwin_core.terrain import bilinear
from numpy.typing import ArrayLike, NDArray

from ..terrain import noise
from . import flame_noise, flame_patches, flame_phase, flame_size, flame_state
from .flame_depth import FrontFields
from .flame_view import FADE, ViewCone

_PIXELS = 2.0  # height in pixels of the typical long flames at the reach (by eye)
_LONG = 90.0  # percentile of the flame lengths of the shown fronts
_BEFORE = 900.0  # s before the first frame from which flames are still seen

_MIDFLAME = 0.4  # wind at the flames over the wind above (P. L. Andrews 2012, RMRS-GTR-266, open fuel)

Array = NDArray[np.float64]


def reach(shot: Any, path: Any) -> float:
    """Return the distance (m) up to which flames are drawn as a volume for a camera.

    There the typical long flames of the shown fronts are 2 pixels high. The distance is at most
    `flame_size.SIGHT`, and 0 without flames, or in an orthographic view.

    Parameters
    ----------
    shot
        A `Shot`.
    path
        A `cameras.path.Path` of the shot.
    """
    if not path.perspective or not shot.settings.fire.flames:
        return 0.0
    return float(min(typical_length(shot) / (_PIXELS * path.pixel), flame_size.SIGHT))


def weight(distance: ArrayLike, limit: float) -> Array:
    """Return the weight 0..1 of the flame volume at a distance (m) for a `reach` (m); 0 if the reach is 0.

    Cards, glowing crowns and the ground's glowing edge have 1 minus this weight.
    """
    if limit <= 0.0:
        return np.zeros(np.shape(distance))
    return 1.0 - noise.smoothstep(FADE[0] * limit, FADE[1] * limit, distance)


def typical_length(shot: Any) -> float:
    """Return the length (m) of the shot's long flames: 90th percentile over the fronts shown; 0 if none."""
    full = shot.full
    ground, front = full.bare_ground, full.front
    first, last = full.frames.span
    shown = (ground.burned >= 0.5) & (ground.arrival <= last) & (ground.arrival >= first - _BEFORE)
    length = cell_lengths(front, full.settings.fire.flame_length)[shown]
    return float(np.percentile(length, _LONG)) if len(length) else 0.0


def cell_lengths(front: FrontFields, formula: str) -> Array:
    """Return the flame length (m) in each cell (ny, nx) of the terrain grid by a formula of `flame_size`."""
    fields = front.ground.fields
    fuel = fields.surface_fuel + fields.canopy_fuel
    intensity = constants.HEAT_OF_COMBUSTION / 1000.0 * fuel * front.speed
    return flame_size.flame_length(intensity, formula, fields.canopy_fuel > flame_size.CROWNS)


def patches(
    shot: Any, eye: Array, time: float, limit: float, pixel: float, lens: ViewCone | None = None
) -> flame_patches.Patches:
    """Return the flames around a camera at a time (s).

    Parameters
    ----------
    eye
        (3,) position of the camera, m.
    limit
        Distance (m) to which flames are drawn; see `reach`.
    pixel
        Size of a pixel over its distance.
    lens
        View of the camera; patches outside of it are left out.
    """
    return flame_patches.build(shot, eye, time, limit, pixel, lens, carrying_wind(shot))


def carrying_wind(shot: Any) -> tuple[float, float]:
    """Return the wind (m/s east and north) that carries the gas of flames."""
    east, north = shot.full.wind
    return _MIDFLAME * east, _MIDFLAME * north


def lengths(shot: Any, place: Array, row: Array, column: Array, time: float) -> Array:
    """Return the height of flames (n,), m, at scene points (n, 2) with their row and column, at a time (s).

    Age decides: flames grow, are tall for a third of the residence time of their fuel, decline, and leave
    low residual flames in patches. Their length follows from the fireline intensity, as for `flames.Points`.
    """
    ground, front = shot.ground, shot.full.front
    row, column = flame_state.shift(shot, place, row, column)
    speed, residence = ground.spread(row, column), bilinear(front.residence, row, column)
    even = flame_state.even_length(shot, row, column)
    uneven = flame_state.patchiness(shot, place, even) * flame_state.tongues(shot, place, even)
    long = np.minimum(even * uneven, flame_state.LONGEST)
    age = time - ground.arrival_at(row, column)
    share = flame_phase.height(age, speed, residence, long, flame_state.patches(shot, place))
    found = long * flame_noise.upright(long, carrying_wind(shot)) * share
    return np.where(found >= flame_state.LEAST, found, 0.0)
