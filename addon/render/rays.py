"""Camera rays through the pixels of a picture, from Blender's current camera."""

from __future__ import annotations

import math
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

from ..shot.cameras import panorama

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Rays:
    """Rays of a picture (h, w).

    Attributes
    ----------
    origins
        (h, w, 3) m, or (3,) if all rays share one origin.
    directions
        (h, w, 3) unit vectors.
    aside
        (h, w) m, lateral offset of origins from the camera, at right angles to the rays.
    slant
        (h, w) ratio of the distance along the ray to Cycles' depth; None: depth is the distance from the
        camera.
    pixel
        Width of a pixel at distance 0, m, and its increase per m of distance.
    """

    origins: Array
    directions: Array
    aside: Array
    slant: Array | None
    pixel: tuple[float, float] = (0.0, 0.0)

    def from_depth(self, depth: NDArray[np.float32]) -> NDArray[np.float32]:
        """Convert Cycles' depths, m, to distances (h, w) along the rays."""
        if self.slant is None:
            return self.from_distance(depth)
        return (depth * self.slant).astype(np.float32)

    def from_distance(self, distance: NDArray[np.float32]) -> NDArray[np.float32]:
        """Convert distances from the camera, m, to distances (h, w) along the rays."""
        square = distance.astype(np.float64) ** 2 - self.aside**2
        return np.sqrt(np.maximum(square, 0.0)).astype(np.float32)


def cells(scene: bpy.types.Scene, side: int) -> tuple[int, int]:
    """Return the numbers of rows and columns of cells of `side` x `side` pixels in a scene's picture."""
    return math.ceil(scene.render.resolution_y / side), math.ceil(scene.render.resolution_x / side)


def cell_rays(camera: bpy.types.Object, scene: bpy.types.Scene, side: int) -> Rays:
    """Compute one ray in each of these cells."""
    return pixel_rays(camera, scene, *cells(scene, side), 0)


def pixel_rays(
    camera: bpy.types.Object,
    scene: bpy.types.Scene,
    height: int,
    width: int,
    eye: float,
    at: tuple[float, float] = (0.5, 0.5),
) -> Rays:
    """Compute the rays through a picture's pixels.

    Parameters
    ----------
    eye
        -1 or 1 for the left or right eye of a stereo camera, else 0.
    at
        Position of the ray in its pixel: to the right and down, 0 to 1.
    """
    placed = np.array(camera.matrix_world)
    rotation = placed[:3, :3] / np.linalg.norm(placed[:3, :3], axis=0)
    place, none = placed[:3, 3], np.zeros((height, width))
    if camera.data.type == "PANO":
        return _around(camera, place, rotation, (height, width), eye, at)
    low, high, axis = _frame(camera, scene)
    x = low[0] + (high[0] - low[0]) * (np.arange(width) + at[0]) / width
    y = high[1] - (high[1] - low[1]) * (np.arange(height) + at[1]) / height
    x, y = np.meshgrid(x, y)
    if camera.data.type == "ORTHO":
        origins = place + np.stack([x, y, none], axis=-1) @ rotation.T
        directions = np.broadcast_to(-rotation[:, 2], origins.shape)
        return Rays(origins, directions, np.hypot(x, y), none + 1.0, (float(high[0] - low[0]) / width, 0.0))
    local = np.stack([x / axis, y / axis, none - 1.0], axis=-1)
    length = np.linalg.norm(local, axis=-1)
    pixel = 0.0, float(high[0] - low[0]) / axis / width
    return Rays(place, (local / length[..., None]) @ rotation.T, none, length, pixel)


def _frame(camera: bpy.types.Object, scene: bpy.types.Scene) -> tuple[Array, Array, float]:
    """Return the image plane in camera space: lower left and upper right corner, and distance."""
    corners = np.array(camera.data.view_frame(scene=scene))
    return corners.min(axis=0), corners.max(axis=0), float(-corners[0, 2])


def _around(
    camera: bpy.types.Object,
    place: Array,
    rotation: Array,
    shape: tuple[int, int],
    eye: float,
    at: tuple[float, float],
) -> Rays:
    """Compute the rays of a spherical panorama."""
    height, width = shape
    bearing, elevation = panorama.pixels(2 * height, width, at)
    bearing, elevation = bearing[:height], elevation[:height]
    aside = 0.5 * eye * camera.data.stereo.interocular_distance * panorama.merged(elevation)
    origins = place + (aside[..., None] * panorama.right(bearing)) @ rotation.T
    directions = panorama.direction(bearing, elevation) @ rotation.T
    return Rays(origins, directions, np.abs(aside), None, (0.0, np.pi / height))
