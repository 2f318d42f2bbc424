"""Mesh tolerance: screen-space error bound of the terrain mesh, by visibility and camera distance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..cameras.mesh_error import NEAREST, UNSEEN
from ..shot import Shot
from . import shadow_casters

_BLOCK = 150.0  # m, size of the blocks that are tested
_MARGIN = 200.0  # m around view frusta from where ground still lights the picture
_FINEST = 6.0  # m, finest spacing; the shortest relief waves are 26 m
_SPACING = 8.0  # errors between the points where surface and mesh are compared
_LIMIT = 6_000_000  # points at most; above it their spacing grows


@dataclass(frozen=True)
class Accuracy:
    """Accuracy required of the terrain mesh.

    Attributes
    ----------
    place
        Terrain grid points (ny, nx, 3) without detail near cameras, m.
    tolerance
        Largest vertical error (ny, nx), m.
    fine
        Number of subdivisions (ny - 1, nx - 1) of each cell, so that heights between grid points count.
    """

    place: NDArray[np.float32]
    tolerance: NDArray[np.float32]
    fine: NDArray[np.uint8]


def wanted(shot: Shot) -> Accuracy:
    """Accuracy for `terrain.error`, which is in pixels of the camera with the finest view."""
    ground = shot.ground
    place = _places(shot)
    size = max(round(_BLOCK / max(ground.cell)), 1)
    centre, radius, rise, shape = _blocks(place, size, 4.0 * ground.rough)
    tolerance, distance = _tolerance(shot, centre, radius, rise, shape)
    fine = _subdivisions(shot, tolerance, distance)
    tolerance, fine = (
        np.repeat(np.repeat(v.reshape(shape), size, axis=0), size, axis=1) for v in (tolerance, fine)
    )
    rows, columns = ground.shape
    fine = fine[: rows - 1, : columns - 1]
    return Accuracy(place, _at_points(tolerance[: rows - 1, : columns - 1]), _within_limit(fine))


def _places(shot: Shot) -> NDArray[np.float32]:
    """Terrain grid points (ny, nx, 3), m; within 8 mm at the apron's end."""
    fields, frame = shot.ground.fields, shot.ground.frame
    place = np.empty((*fields.elevation.shape, 3), np.float32)
    for first in range(0, len(place), 256):
        part = slice(first, first + 256)
        place[part] = frame.forward_grid(fields.latitude[part], fields.longitude, fields.elevation[part])
    return place


def _blocks(
    place: NDArray[np.float32], size: int, more: float
) -> tuple[NDArray, NDArray, NDArray, tuple[int, int]]:
    """Blocks of `size` cells: bounding spheres (n, 3), (n,), m, half heights (n,), m, and block counts.

    `more` is added to radius and half height.
    """
    rows, columns = (np.arange(0, count - 1, size) for count in place.shape[:2])
    low, high = place[rows][:, columns], place
    ends = [
        np.minimum(first + size, count - 1)
        for first, count in zip((rows, columns), place.shape[:2], strict=True)
    ]
    high = place[ends[0]][:, ends[1]]
    z = place[..., 2]
    least, most = z.copy(), z.copy()
    for axis, (first, last) in enumerate(zip((rows, columns), ends, strict=True)):
        least = np.minimum(np.minimum.reduceat(least, first, axis), np.take(least, last, axis))
        most = np.maximum(np.maximum.reduceat(most, first, axis), np.take(most, last, axis))
    centre = np.stack([*(0.5 * (low[..., k] + high[..., k]) for k in (0, 1)), 0.5 * (least + most)], axis=-1)
    across = np.hypot(*(0.5 * np.abs(high[..., k] - low[..., k]) for k in (0, 1)))
    radius = np.hypot(1.05 * across, 0.5 * (most - least)) + more
    rise = 0.5 * (most - least) + more
    return (
        centre.reshape(-1, 3).astype(np.float64),
        radius.ravel().astype(np.float64),
        rise.ravel().astype(np.float64),
        (len(rows), len(columns)),
    )


def _tolerance(
    shot: Shot, centre: NDArray, radius: NDArray, rise: NDArray, shape: tuple[int, int]
) -> tuple[NDArray, NDArray]:
    """Vertical error bound (n,) of blocks, m, and distance of the cameras that see them; infinite if none."""
    tolerance, distance = np.full(len(centre), UNSEEN), np.full(len(centre), np.inf)
    bounds = shot.visibility.bounds

    def shaded(visible: NDArray[np.bool_]) -> NDArray[np.bool_]:
        return shadow_casters.with_shade(
            shot, centre.reshape(*shape, 3), rise.reshape(shape), visible.reshape(shape)
        ).ravel()

    near = np.zeros(len(centre), bool)
    if bounds.angle is not None:
        near = shot.visibility.visible_mask(centre, radius, margin=_MARGIN)
        visible = shaded(near)
        distance[visible] = np.maximum(shot.visibility.distance(centre[visible]) - radius[visible], NEAREST)
        drawn = shot.visibility.lod_distance(centre[visible]) - radius[visible]
        tolerance[visible] = bounds.perspective(drawn)
    if bounds.pixel is not None:
        far = shot.visibility.visible_mask(centre, radius, margin=_MARGIN, pixel=np.inf, perspective=False)
        visible = shaded(near | far)
        tolerance[visible] = np.minimum(tolerance[visible], bounds.pixel)
    return tolerance, distance


def _subdivisions(shot: Shot, tolerance: NDArray, distance: NDArray) -> NDArray[np.int64]:
    """Count the subdivisions of blocks where the surface is finer than its grid, from the error bounds."""
    ground = shot.ground
    finest = min(_FINEST, max(ground.cell) / ground.patch.parts) if ground.patch else _FINEST
    spacing = np.maximum(_SPACING * tolerance, finest)
    halvings = np.ceil(np.log2(max(ground.cell) / spacing)).astype(np.int64)
    return np.where(distance < ground.near_radius, np.maximum(halvings, 1), 0)


def _within_limit(fine: NDArray[np.int64]) -> NDArray[np.uint8]:
    """Reduce the largest subdivisions until at most `_LIMIT` points remain."""
    while np.sum(4.0**fine, where=fine > 0) > _LIMIT:
        fine = np.minimum(fine, max(int(fine.max()) - 1, 0))
    return fine.astype(np.uint8)


def _at_points(cells: NDArray[np.float64]) -> NDArray[np.float32]:
    """Values at grid points: the minimum over adjacent cells."""
    padded = np.pad(cells, 1, "edge")
    down = np.minimum(padded[:-1], padded[1:])
    return np.minimum(down[:, :-1], down[:, 1:]).astype(np.float32)
