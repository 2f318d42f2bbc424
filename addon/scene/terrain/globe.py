"""The Earth beyond the terrain: the ellipsoid as a single mesh, joined to the border of the apron.

It is built only for cameras that see it. Its heights start at the border's and fade to sea level within some
hundred kilometres, since no terrain data are available there.
"""

from __future__ import annotations

import bpy
import numpy as np
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...blender import owned
from ...blender.mesh import create_mesh
from ...blender.owned import Stage
from ...ellipsoid import MEAN_RADIUS
from ...errors import input_error, reading
from ...run import areas
from ...shot.shot import Shot
from ...shot.surface import globe_picture
from ...shot.terrain.terrain import Terrain
from . import globe_material

_SIDE = 96  # points along a side of the border
_FIRST, _GROWTH, _STEP = 3000.0, 1.09, 100_000.0  # m: first step between rings, its growth, largest step
_HILLS, _LAND = 8_000.0, 300_000.0  # m beyond the border over which hills and mean height fade
_SKIRT = (
    0.97,
    400.0,
)  # fraction of its distance, and m below it, of a skirt under the border

Array = NDArray[np.float64]


def build(
    shot: Shot, stage: Stage, collection: bpy.types.Collection, image: bpy.types.Image
) -> bpy.types.Object:
    """Build "Firetwin Globe" in a Firetwin collection."""
    position, triangles = create_shell(shot.ground)
    data = create_mesh("Firetwin Globe", position, triangles)
    data.materials.append(globe_material.build(shot, stage, image))
    obj = owned.add(collection, "Globe", data)
    for kind in ("shadow", "diffuse", "glossy", "transmission", "volume_scatter"):
        setattr(obj, f"visible_{kind}", False)
    return obj


def load_picture(shot: Shot) -> bpy.types.Image:
    """Load the user's picture of the Earth, else the default, which is packed into the file.

    Raises
    ------
    InputError
        The picture is damaged.
    """
    path = shot.settings.terrain.globe
    place = (path or globe_picture.DEFAULT).absolute()
    with reading(place):
        image = owned.mark(bpy.data.images.load(str(place)))
        size = tuple(image.size)  # of the decoded picture
    image.buffers_free()
    if 0 in size:
        raise input_error(place, "is damaged or not a picture; export it again as JPEG or PNG")
    image.name = "Firetwin Globe"
    if path is None:
        image.pack()
    return image


def border_share(ground: Terrain, row: Array, column: Array) -> NDArray[np.float32]:
    """Return the position (n,) from the run's edge, 0, to the border, 1, at fractional rows and columns."""
    fields = ground.fields
    if fields.margin == 0:
        return np.zeros(len(row), np.float32)
    sizes = areas.metres_per_degree(ground.frame.latitude)
    inside, reach = [], []
    for at, axis, size in zip(
        ground.places(row, column), (fields.latitude, fields.longitude), sizes, strict=True
    ):
        inside.append(np.minimum(at - axis[0], axis[-1] - at) * size)
        reach.append((axis[fields.margin] - axis[0]) * size)
    return np.clip(1.0 - np.minimum(*inside) / min(reach), 0.0, 1.0).astype(np.float32)


def create_shell(ground: Terrain) -> tuple[Array, NDArray[np.int32]]:
    """Create vertices (n, 3), m, and triangles (m, 3): rings from the terrain's border around the Earth."""
    latitude, longitude, height = _border_points(ground)
    bearing, arc = _to_polar(ground, latitude, longitude)
    mean = float(height.mean())
    rings = [
        _from_polar(ground, bearing, arc * _SKIRT[0], height - _SKIRT[1]),
        _from_polar(ground, bearing, arc, height),
    ]
    for way in _ring_fractions(np.pi - float(arc.min())):
        beyond = MEAN_RADIUS * way * (np.pi - float(arc.min()))
        rise = mean + (height - mean) * np.exp(-beyond / _HILLS)
        rings.append(_from_polar(ground, bearing, arc + way * (np.pi - arc), rise * np.exp(-beyond / _LAND)))
    position = np.concatenate(rings)
    return position, _triangles(len(rings), len(latitude))


def _border_points(ground: Terrain) -> tuple[Array, Array, Array]:
    """Return latitude, longitude (degrees) and height (m) of points around the border, counter-clockwise."""
    rows, columns = ground.shape
    part = np.arange(_SIDE) / _SIDE
    low, high = np.zeros(_SIDE), np.ones(_SIDE)
    down = np.concatenate([low, part, high, 1.0 - part])
    across = np.concatenate([part, high, 1.0 - part, low])
    fields = ground.fields
    latitude = fields.latitude[0] + down * (fields.latitude[-1] - fields.latitude[0])
    longitude = fields.longitude[0] + across * (fields.longitude[-1] - fields.longitude[0])
    row, column = ground.indices(latitude, longitude)
    row, column = np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)
    return latitude, longitude, bilinear(fields.elevation, row, column)


def _to_polar(ground: Terrain, latitude: Array, longitude: Array) -> tuple[Array, Array]:
    """Return bearing and arc (radians) of points (degrees) from the scene's origin, on the sphere."""
    here, there = np.radians(ground.frame.latitude), np.radians(latitude)
    away = np.radians(longitude - ground.frame.longitude)
    east = np.cos(there) * np.sin(away)
    north = np.cos(here) * np.sin(there) - np.sin(here) * np.cos(there) * np.cos(away)
    up = np.sin(here) * np.sin(there) + np.cos(here) * np.cos(there) * np.cos(away)
    return np.arctan2(east, north), np.arctan2(np.hypot(east, north), up)


def _from_polar(ground: Terrain, bearing: Array, arc: Array, height: Array) -> Array:
    """Return positions (n, 3) of bearings and arcs from the scene's origin: inverse of `_to_polar`."""
    here = np.radians(ground.frame.latitude)
    sine = np.sin(here) * np.cos(arc) + np.cos(here) * np.sin(arc) * np.cos(bearing)
    latitude = np.arcsin(np.clip(sine, -1.0, 1.0))
    away = np.arctan2(
        np.sin(bearing) * np.sin(arc) * np.cos(here), np.cos(arc) - np.sin(here) * np.sin(latitude)
    )
    longitude = ground.frame.longitude + np.degrees(away)
    return ground.frame.forward(np.degrees(latitude), longitude, height)


def _ring_fractions(arc: float) -> Array:
    """Return fractions (n,) of an arc (radians) at which rings are placed, the last at its end."""
    steps, total, step = [0.0], 0.0, _FIRST
    while total < arc * MEAN_RADIUS:
        steps.append(total)
        total, step = total + step, min(step * _GROWTH, _STEP)
    return np.append(np.array(steps) / (arc * MEAN_RADIUS), 1.0)


def _triangles(rings: int, around: int) -> NDArray[np.int32]:
    """Create triangles between rings of points; the first two are a skirt, not joined to the rest."""
    at = np.arange(around)
    after = (at + 1) % around
    triangles = []
    for ring in (0, *range(2, rings - 1)):
        low, high = ring * around, (ring + 1) * around
        triangles += [
            np.stack([low + at, high + at, low + after], axis=-1),
            np.stack([low + after, high + at, high + after], axis=-1),
        ]
    return np.concatenate(triangles).astype(np.int32)
