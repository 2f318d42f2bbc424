"""Map of flame length over the ground, from which flames near a camera are drawn as a volume.

Needs no Blender.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from firetwin_core import constants
from numpy.typing import ArrayLike, NDArray

from ..terrain import noise
from . import flame_size
from .flame_depth import FrontFields

if TYPE_CHECKING:
    from firetwin_core.run import Run

_PIXELS = 3.0  # height in pixels of the typical long flames at the reach (by eye)
_FADE = (0.8, 1.2)  # distances over the reach between which the field fades out
_LONG = 90.0  # percentile of the flame lengths of the shown fronts
_BEFORE = 900.0  # s before the first frame from which flames are still seen

Array = NDArray[np.float64]


def reach(shot: Any, path: Any) -> float:
    """Return the distance (m) up to which flames are drawn as a volume for a camera.

    There the typical long flames of the shown fronts are 3 pixels high. The distance is at most
    `flame_size.SIGHT`, and 0 if another renderer draws the smoke, without flames, or in an orthographic view.

    Parameters
    ----------
    shot
        A `Shot`.
    path
        A `cameras.path.Path` of the shot.
    """
    if not path.perspective or not is_marched(shot.settings, shot.run):
        return 0.0
    return float(min(typical_length(shot) / (_PIXELS * path.pixel), flame_size.SIGHT))


def weight(distance: ArrayLike, limit: float) -> Array:
    """Return the weight 0..1 of the flame volume at a distance (m) for a `reach` (m); 0 if the reach is 0.

    Cards, glowing crowns and the ground's glowing edge have 1 minus this weight.
    """
    if limit <= 0.0:
        return np.zeros(np.shape(distance))
    return 1.0 - noise.smoothstep(_FADE[0] * limit, _FADE[1] * limit, distance)


def is_marched(settings: Any, run: Run) -> bool:
    """Return whether flames are ray-marched: with smoke that is ray-marched, or without smoke, in Cycles."""
    smoke, fire = settings.smoke, settings.fire
    if settings.render.engine != "cycles" or smoke.draw != "integrated":
        return False
    if not fire.flames or fire.emitters != "front":
        return False
    solved = smoke.method == "flow" and smoke.lighting == "solved" and "smoke_3d" not in run.fields
    return solved or not smoke.enabled


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
