"""Which plants count for a shot: those that its cameras see, and those that shade what they see."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...shot.ground import Ground
from ...shot.shot import Shot
from . import models

PIXEL = 25.0  # m; a satellite whose pixels are larger sees no tree
_AROUND = 30.0  # m; a tree farther beside the view than it is tall takes little light of the sky from it
_RELIEF = 30.0  # m; so far up and down the drawn ground's relief may move a tree


def visible(
    shot: Shot, foot: NDArray, height: NDArray | float, reach: float, wider: NDArray | float = 1.0
) -> NDArray[np.bool_]:
    """Which plants (n,) `height` m tall with feet at (n, 3) count: seen, or throwing shadows on what is.

    Those beside a view within `_AROUND` count too, as they take light of the sky from it; those farther away
    than `reach` or too small for a satellite do not. `wider` than their models they reach farther from their
    middles. Shadows are as long as the sun is low in each frame (`lod.seen`), so no margin is guessed.
    """
    height = np.broadcast_to(height, len(foot))
    middle = np.column_stack([foot[:, :2], foot[:, 2] + 0.5 * height])
    radius = models.REACH * height * np.maximum(wider, 1.0)
    return shot.sights.seen(middle, radius, reach=reach, margin=_AROUND, shadows=True, pixel=PIXEL)


def too_far(shot: Shot) -> bool:
    """Whether there are satellites, and none whose pixels are small enough for trees."""
    return PIXEL <= shot.pixel[1] < np.inf


def cells(
    shot: Shot,
    height: float,
    reach: float,
    place: NDArray[np.float64] | None = None,
    among: NDArray[np.bool_] | None = None,
) -> NDArray[np.bool_]:
    """Cells where a plant of at most this height may count, of middles (fy, fx, 3) or the run's fuel cells.

    Parameters
    ----------
    among
        (fy, fx) only these are looked at.
    """
    place = middles(shot) if place is None else place
    slope = sum(_steps(place[..., 2], axis) for axis in (0, 1))
    size = np.hypot(0.5 * np.hypot(*shot.ground.cell), slope) + max(_RELIEF, shot.ground.rough)
    among = np.ones(size.shape, bool) if among is None else among
    counts = np.zeros(size.shape, bool)
    counts[among] = visible(shot, place[among], height + size[among] / models.REACH, reach)
    return counts


def middles(shot: Shot) -> NDArray[np.float64]:
    """Middles (fy, fx, 3) of the run's fuel cells in the scene, m."""
    run = shot.run
    return shot.local_frame.forward_grid(run.fuel_latitude, run.fuel_longitude, shot.relief.fuel)


def _steps(height: NDArray[np.float64], axis: int) -> NDArray[np.float64]:
    """Largest difference of each height from its neighbours' along an axis, where they are known."""
    padded = np.pad(height, [(1, 1) if k == axis else (0, 0) for k in (0, 1)], "edge")
    step = np.nan_to_num(np.abs(np.diff(padded, axis=axis)))
    return np.lib.stride_tricks.sliding_window_view(step, 2, axis).max(-1)


def settled(ground: Ground, position: NDArray[np.float64]) -> NDArray[np.float64]:
    """Positions on the ground as it is drawn."""
    position = position.copy()
    near = np.flatnonzero(ground.detail(*position.T) > 0.0)
    if len(near):
        position[near, 2] = ground.up(position[near, 0], position[near, 1])
    return position
