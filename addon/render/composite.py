"""Pictures from surfaces that Cycles drew and smoke that was marched, in linear light. Needs no Blender.

A ray's smoke is known at taps: what it adds up to there, and the transmittance. A pixel at a silhouette shows
a near surface and a far one: its taps are the nearest and the farthest depth of its 3 x 3 neighbours. How
they share it is told by the mean nearness (1 / distance) of its rays, few as they are, and by its neighbours.
Flames have a distance of their own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..shot.cameras.pixel_rays import SKY

Array = NDArray[np.float32]

_EDGE = 0.02  # transmittance that differs across a silhouette
_REACH, _ALIKE = 2, 0.1  # pixels round an edge, and how far their depth may differ, of itself
_SURE = 15.0  # rays that tell a pixel's share as well as its neighbours do; estimated


@dataclass(frozen=True)
class Surfaces:
    """What Cycles drew of a picture (h, w) without smoke.

    Attributes
    ----------
    colour
        (h, w, 3) radiance of all; denoised, if it is to be.
    noisy
        The same before it was denoised.
    fire
        (h, w, 3) of that the light of flames, firebrands and labels.
    distance
        (h, w) m along the ray through the pixel's middle; over `SKY` where there is nothing.
    nearness
        (h, w) mean of 1000 m over the distance of solid surfaces from the camera, 0 for the sky.
    aside
        (h, w) m that rays begin beside the camera.
    solid
        (h, w) part of rays that met a surface that knows its distance.
    fire_distance
        (h, w) m, mean over the flames by their light; 0: none.
    rays
        Of a pixel.
    """

    colour: Array
    noisy: Array
    fire: Array
    distance: Array
    nearness: Array
    aside: Array
    solid: Array
    fire_distance: Array
    rays: int


def taps(surfaces: Surfaces) -> Array:
    """Distances (h, w, 3), m, where the smoke before a pixel must be known: near, far and flames."""
    near, far = _around(surfaces.distance, np.minimum), _around(surfaces.distance, np.maximum)
    return np.stack([near, far, surfaces.fire_distance], axis=-1)


def picture(surfaces: Surfaces, seen: Array, marched: Array) -> Array:
    """Radiance (h, w, 3) of surfaces behind smoke.

    Parameters
    ----------
    seen
        (h, w, 3) m, as `taps` gave it.
    marched
        (h, w, 3, 4) at these, as `firetwin_core.volume.march` gives it.
    """
    share = _share(surfaces, seen)[..., None]
    smoke, through = marched[..., :3], marched[..., 3:]
    near, far, flames = (through[:, :, k] for k in range(3))
    fire = _fire(surfaces)
    solid = surfaces.colour - fire
    behind = solid * (share * near + (1.0 - share) * far)
    edge = np.abs(near - far)[..., 0] > _EDGE
    inner = _beside(solid, seen[..., 0], edge)
    # The near part of an edge has its neighbours' colour: a denoiser has mixed it with what is far, such as
    # fire that smoke hides.
    split = share * inner * (near - far) + solid * far
    behind = np.where(edge[..., None], split, behind)
    light = share * smoke[:, :, 0] + (1.0 - share) * smoke[:, :, 1]
    return (np.maximum(behind + fire * flames, 0.0) + light).astype(np.float32)


def radiance(surface: Array, flames: Array, warmth: Array, sky: float) -> Array:
    """Infrared radiance (h, w) before smoke, W m-2 sr-1, from AOVs (see `blender.nodes`).

    Parameters
    ----------
    surface, flames
        (h, w, 3).
    warmth
        (h, w).
    sky
        Of the clear sky, W m-2 sr-1.
    """
    emissivity = flames[..., 2]
    behind = surface[..., 2] + np.clip(1.0 - surface[..., 1], 0.0, 1.0) * sky
    # Emissivities of flames behind one another add up past 1: such a pixel is as bright as their mean.
    return warmth / np.maximum(emissivity, 1.0) + np.clip(1.0 - emissivity, 0.0, 1.0) * behind


def _share(surfaces: Surfaces, seen: Array) -> Array:
    """Part (h, w) of each pixel that is its near surface."""
    near, far = (1000.0 / np.hypot(seen[..., k], surfaces.aside) for k in (0, 1))
    apart = near - far
    share = np.clip((surfaces.nearness - far) / np.where(apart > 0.0, apart, 1.0), 0.0, 1.0)
    sure = surfaces.rays / (surfaces.rays + _SURE)
    share = sure * share + (1.0 - sure) * _nearer(surfaces.distance, seen)
    # An artist's material says nothing of its distance: what the middle ray met is all that is known.
    unknown = (surfaces.solid < 0.5) & (surfaces.distance < SKY)
    share = np.where(unknown, surfaces.distance <= seen[..., 0] * (1.0 + _ALIKE), share)
    return np.where(apart > 1.0e-3 * near, share, 1.0)


def _nearer(distance: Array, seen: Array) -> Array:
    """Part (h, w) of the 3 x 3 round each pixel that is as near as its near tap, the middle counting most."""
    middle = np.sqrt(seen[..., 0] * np.minimum(seen[..., 1], 1.0e10))
    padded = np.pad(distance, 1, mode="edge")
    height, width = distance.shape
    total = np.zeros((height, width), np.float32)
    for down, row in enumerate((0.25, 0.5, 0.25)):
        for across, column in enumerate((0.25, 0.5, 0.25)):
            there = padded[down : down + height, across : across + width]
            total += np.float32(row * column) * (there < middle)
    return total


def _fire(surfaces: Surfaces) -> Array:
    """Of the colour (h, w, 3) the light of flames: as large a part as round there, as denoisers spread it."""
    part = blurred(surfaces.fire) / np.maximum(blurred(surfaces.noisy), 1.0e-6)
    alight = (surfaces.fire_distance > 0.0)[..., None]
    return np.where(alight, surfaces.colour * np.clip(part, 0.0, 1.0), 0.0)


def blurred(values: Array) -> Array:
    """Weighted mean (h, w, c) of each pixel's 3 x 3, the middle counting most."""
    padded = np.pad(values, ((1, 1), (1, 1), (0, 0)), mode="edge")
    rows = 0.25 * padded[:-2] + 0.5 * padded[1:-1] + 0.25 * padded[2:]
    return 0.25 * rows[:, :-2] + 0.5 * rows[:, 1:-1] + 0.25 * rows[:, 2:]


def _around(values: Array, pick: np.ufunc) -> Array:
    """The least or greatest of each pixel's 3 x 3."""
    padded = np.pad(values, 1, mode="edge")
    rows = pick(pick(padded[:-2], padded[1:-1]), padded[2:])
    return pick(pick(rows[:, :-2], rows[:, 1:-1]), rows[:, 2:])


def _beside(colour: Array, near: Array, edge: NDArray[np.bool_]) -> Array:
    """Colour (h, w, 3) with that of pixels at edges from round them: the mean of those as near that are not.

    Where there are none it is the darkest of its 3 x 3: what shines there by mistake is fire behind smoke.
    """
    found = colour.copy()
    rows, columns = np.nonzero(edge)
    if len(rows) == 0:
        return found
    height, width = edge.shape
    darkest = np.stack([_around(colour[..., channel], np.minimum) for channel in range(3)], axis=-1)
    total, weight = np.zeros((len(rows), 3), np.float32), np.zeros(len(rows), np.float32)
    here = near[rows, columns]
    for down in range(-_REACH, _REACH + 1):
        for across in range(-_REACH, _REACH + 1):
            row, column = rows + down, columns + across
            inside = (row >= 0) & (row < height) & (column >= 0) & (column < width)
            row, column = np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)
            alike = inside & ~edge[row, column] & (np.abs(near[row, column] - here) < _ALIKE * here)
            part = np.float32(np.exp(-0.5 * (down**2 + across**2))) * alike
            total += part[:, None] * colour[row, column]
            weight += part
    mean = total / np.maximum(weight, 1.0e-9)[:, None]
    found[rows, columns] = np.where(weight[:, None] > 0.0, mean, darkest[rows, columns])
    return found
