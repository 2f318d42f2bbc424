"""Which plants count for a shot: those that its cameras see, and those that shade what they see."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...shot.shot import Shot
from ...shot.terrain.terrain import Ground
from . import models

PIXEL = 25.0  # m; a satellite whose pixels are larger sees no tree
_AROUND = 30.0  # m; a tree farther beside the view than it is tall takes little light of the sky from it


def visible(
    shot: Shot,
    foot: NDArray,
    height: NDArray | float,
    reach: float,
    wider: NDArray | float = 1.0,
    beside: NDArray | float = 0.0,
) -> NDArray[np.bool_]:
    """Which plants (n,) `height` m tall with feet at (n, 3) count: seen, or throwing shadows on what is.

    Those beside a view within `_AROUND` count too, as they take light of the sky from it; those farther away
    than `reach` or too small for a satellite do not. `wider` than their models they reach farther from their
    middles; feet may be so far `beside` their places, m. Shadows are as long as the sun is low in each frame
    (`lod.visible_mask`), so no margin is guessed.
    """
    height = np.broadcast_to(height, len(foot))
    middle = np.column_stack([foot[:, :2], foot[:, 2] + 0.5 * height])
    radius = models.REACH * height * np.maximum(wider, 1.0) + beside
    return shot.visibility.visible_mask(
        middle, radius, reach=reach, margin=_AROUND, shadows=True, pixel=PIXEL
    )


def too_far(shot: Shot) -> bool:
    """Whether there are satellites, and none whose pixels are small enough for trees."""
    return PIXEL <= shot.pixel[1] < np.inf


def settled(ground: Ground, position: NDArray[np.float64]) -> NDArray[np.float64]:
    """Positions on the ground as it is drawn."""
    position = position.copy()
    near = np.flatnonzero(ground.detail(*position.T) > 0.0)
    if len(near):
        position[near, 2] = ground.up(position[near, 0], position[near, 1])
    return position
