"""Visibility of plants: frustum and occlusion culling, with plants that shade visible ground retained."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...shot.shot import Shot
from ...shot.terrain.terrain import Terrain
from . import models

PIXEL = 4.0  # m; in a satellite's larger pixels the ground's canopy represents trees, across the run's border
AROUND = 30.0  # m; ambient occlusion of a view by trees outside of it ends here, or at their height
TREES_END = 1.25
"""Factor on the draw distance of trees; beyond it the ground's material alone shows the canopy."""
_GOLDEN = 0.6180339887  # golden ratio - 1; its multiples are evenly spread


def visible(
    shot: Shot,
    foot: NDArray,
    height: NDArray | float,
    reach: float,
    wider: NDArray | float = 1.0,
    offset: NDArray | float = 0.0,
) -> NDArray[np.bool_]:
    """Find plants (n,) `height` m tall with bases at (n, 3) that are visible or shade visible ground.

    Plants within `AROUND` of a view are retained too, as they occlude the sky's light. Plants beyond
    `reach`, or too small for a satellite, are culled. `wider` scales the bounding spheres; `offset` is the
    largest offset of bases, m. Shadow lengths follow the sun's elevation in each frame (`lod.visible_mask`),
    so no margin is assumed.
    """
    middle, radius = bounds(foot, np.broadcast_to(height, len(foot)), wider)
    return shot.visibility.visible_mask(
        middle, radius + offset, reach=reach, margin=AROUND, shadows=True, pixel=PIXEL
    )


def is_drawn(
    place: NDArray[np.float64], eyes: Sequence[NDArray[np.float64]], reach: float
) -> NDArray[np.bool_]:
    """Test whether trees at places (n, 3) are within the draw distance (m) of an eye; all without eyes.

    Their number falls to 0 between one and `TREES_END` draw distances: the ground's colour replaces them.
    """
    if not eyes:
        return np.ones(len(place), bool)
    away = np.min([np.linalg.norm(place - eye, axis=1) for eye in eyes], axis=0)
    chance = np.arange(len(place)) * _GOLDEN % 1.0
    return away <= reach * (1.0 + (TREES_END - 1.0) * chance)


def bounds(foot: NDArray, height: NDArray, wider: NDArray | float) -> tuple[NDArray, NDArray]:
    """Return bounding spheres of plants (n,), as `visible` takes them: centres (n, 3) and radii (n,), m."""
    middle = np.column_stack([foot[:, :2], foot[:, 2] + 0.5 * height])
    return middle, models.REACH * height * np.maximum(wider, 1.0)


def too_far(shot: Shot) -> bool:
    """Return True if the shot has satellites, but none with pixels small enough for trees."""
    return PIXEL <= shot.pixel[1] < np.inf


def settled(ground: Terrain, position: NDArray[np.float64]) -> NDArray[np.float64]:
    """Positions projected vertically onto the terrain mesh."""
    position = position.copy()
    near = np.flatnonzero(ground.detail(*position.T) > 0.0)
    if len(near):
        position[near, 2] = ground.up(position[near, 0], position[near, 1])
    return position
