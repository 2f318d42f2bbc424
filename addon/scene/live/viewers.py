"""Viewers of the live scene: the places around which it is finest."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...shot.shot import Shot

_MOMENTS = 5  # of each camera
_NEAREST = 20.0  # m


def places(shot: Shot) -> NDArray[np.float64]:
    """Return places (n, 3), m: of cameras near the ground, and of their targets."""
    points = [np.zeros((0, 3))]
    for path in shot.perspective_paths:
        frames = np.linspace(0, len(path.position) - 1, _MOMENTS).round().astype(int)
        points += [path.position[frames], path.target[frames]]
    if len(points) == 1:
        points.append(np.array([[0.0, 0.0, float(np.nanmax(shot.ground.fields.elevation))]]))
    return np.concatenate(points)


def distance(shot: Shot, positions: NDArray[np.floating]) -> NDArray[np.float64]:
    """Return distances (...), m, of positions (..., 3) from the nearest viewer."""
    nearest = np.full(positions.shape[:-1], np.inf)
    for place in places(shot):
        np.minimum(nearest, np.linalg.norm(positions - place, axis=-1), out=nearest)
    return np.maximum(nearest, _NEAREST)


def target(shot: Shot) -> NDArray[np.float64]:
    """Return the place (3,), m, at which the cameras look on average; the middle of the fire without any."""
    if shot.perspective_paths:
        return np.mean([path.target.mean(axis=0) for path in shot.perspective_paths], axis=0)
    return places(shot)[0]
