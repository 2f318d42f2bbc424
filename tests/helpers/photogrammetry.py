"""A tileset as photogrammetry makes it: one surface with crowns and roofs in it, on ground of known truth."""

import json
from dataclasses import dataclass

import numpy as np
from firetwin.ellipsoid import ecef
from firetwin.tiles.make import glb
from numpy.typing import NDArray
from PIL import Image

STEP = 2.0  # m between vertices


@dataclass(frozen=True)
class Scene:
    """Surface at points (ny, nx) from south-west, scene metres."""

    east: NDArray
    north: NDArray
    ground: NDArray
    height: NDArray
    roof: NDArray
    growth: NDArray


def scene(up, middle, half, off=0.0, spacing=14.0, seed=4):
    """A scene around `middle` (east, north): a wood on its west side, houses on its east side, m.

    Parameters
    ----------
    up
        Ground as a function of east and north (n,).
    off
        m that the tiles' ground is above that.
    """
    axis = np.arange(-half, half + 0.5 * STEP, STEP)
    east, north = np.meshgrid(middle[0] + axis, middle[1] + axis)
    ground = up(east.ravel(), north.ravel()).reshape(east.shape) + off
    rng = np.random.default_rng(seed)
    growth, roof, height = np.zeros(east.shape), np.zeros(east.shape, bool), ground.copy()
    for x in np.arange(-half + 10.0, -0.1 * half, spacing):
        for y in np.arange(-half + 10.0, half - 10.0, spacing):
            x0, y0 = middle + np.array([x, y]) + rng.uniform(-3, 3, 2)
            away = np.hypot(east - x0, north - y0) / rng.uniform(3, 5)
            growth = np.maximum(growth, rng.uniform(9, 18) * np.clip(1.0 - away, 0, None) ** 0.7)
    for x in np.arange(0.15 * half, 0.85 * half, 40.0):
        for y in np.arange(-0.8 * half, 0.8 * half, 40.0):
            inside = (np.abs(east - middle[0] - x) <= 8) & (np.abs(north - middle[1] - y) <= 6)
            roof |= inside
            height[inside] = ground[inside].max() + 6.0
    return Scene(east, north, ground, np.where(roof, height, ground + growth), roof, growth * ~roof)


def write(folder, frame, surface, undulation=lambda latitude, longitude: 0.0):
    """Write a scene as a tileset of one tile; `undulation` is the geoid's height, m, at places in degrees."""
    folder.mkdir(parents=True)
    local = np.stack([surface.east, surface.north, surface.height], axis=-1).reshape(-1, 3)
    latitude, longitude, height = frame.reverse(local)
    place = ecef(np.radians(latitude), np.radians(longitude), height + undulation(latitude, longitude))
    origin = np.round(place.mean(axis=0))
    rows, columns = surface.east.shape
    number = np.arange(rows * columns).reshape(rows, columns)
    low, right, top, far = (
        part.ravel() for part in (number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:])
    )
    triangles = np.vstack([np.column_stack([low, right, top]), np.column_stack([right, far, top])])
    v, u = np.meshgrid(np.linspace(1, 0, rows), np.linspace(0, 1, columns), indexing="ij")
    colour = np.where(surface.growth[..., None] > 0.5, (40, 62, 30), (128, 112, 84))
    colour = np.where(surface.roof[..., None], (150, 60, 48), colour).astype(np.uint8)
    Image.fromarray(colour[::-1]).save(folder / "picture.jpg", quality=92)
    mesh = glb.Mesh(
        origin=origin,
        position=place - origin,
        normal=place / np.linalg.norm(place, axis=1, keepdims=True),
        triangles=triangles,
        uv=np.column_stack([u.ravel(), v.ravel()]),
        picture=(folder / "picture.jpg").read_bytes(),
    )
    (folder / "tile.glb").write_bytes(glb.encode(mesh, ""))
    ball = [*origin.tolist(), float(np.linalg.norm(place - origin, axis=1).max())]
    root = {"boundingVolume": {"sphere": ball}, "geometricError": 0.0, "refine": "REPLACE"}
    whole = {
        "asset": {"version": "1.1"},
        "geometricError": 100.0,
        "root": root | {"content": {"uri": "tile.glb"}},
    }
    (folder / "tileset.json").write_text(json.dumps(whole))
    return folder
