"""glTF terrain: one mesh with the colours before the fire, and a picture of the arrival times.

The mesh is coarser than the scene's: its tolerance is a pixel of the scene's cameras. The picture "arrival"
has the texture coordinates of the terrain. Red times 256 plus green is the arrival time in steps, which the
material's extras describe.
"""

from __future__ import annotations

import numpy as np
from firetwin_core import sensor, terrain
from numpy.typing import NDArray

from ..scene.terrain import ground_picture
from ..shot.shot import Shot
from ..shot.surface import mesh_tolerance
from ..shot.terrain.terrain import NEVER
from ..tiles.make import glb, pictures
from .gltf_document import Document
from .scene_content import Array, TerrainMesh

_ERROR = 1.0  # pixels
_NEVER = 65535
BEFORE = -1.0e12
"""Model time before any fire, s."""


def add(document: Document, shot: Shot, span: tuple[float, float]) -> None:
    """Append the ground of a shot, with the arrival times of a span of model times (s)."""
    mesh = _mesh(shot)
    ground = document.texture("ground", pictures.encode(ground_picture.paint(shot, np.array([BEFORE]))[0]))
    arrival, step = encode_arrival(_arrival(shot), *span)
    extras = {"arrival": {"texture": document.texture("arrival", arrival), "step_s": step, "never": _NEVER}}
    material = document.material("ground", texture=ground, extras=extras)
    uv = mesh.uv * (1.0, -1.0) + (0.0, 1.0)
    attributes = {
        "POSITION": document.vectors(mesh.points, bounds=True),
        "NORMAL": document.vectors(mesh.normals),
        "TEXCOORD_0": document.buffer.accessor(uv, glb.FLOAT, "VEC2", glb.VERTICES),
    }
    part = {
        "attributes": attributes,
        "indices": document.indices(mesh.triangles, len(mesh.points)),
        "material": material,
    }
    document.node("terrain", mesh=document.add("meshes", {"name": "terrain", "primitives": [part]}))


def _mesh(shot: Shot) -> TerrainMesh:
    """Make the ground's mesh as the scene does, with a larger tolerance and under 3D Tiles too."""
    ground, wanted = shot.ground, mesh_tolerance.wanted(shot)
    coarser = max(_ERROR / shot.settings.terrain.error, 1.0)
    row, column, triangles = terrain.mesh(
        wanted.place,
        (coarser * wanted.tolerance).astype(np.float32),
        wanted.fine,
        ground.surface,
        ground.eyes,
        ground.near_radius,
        ground.fields.margin,
    )
    points = ground.point(*ground.places(row, column))
    rows, columns = ground.shape
    uv = np.column_stack([(column + 0.5) / columns, (row + 0.5) / rows])
    return TerrainMesh(
        points.astype(np.float32),
        triangles.astype(np.int64),
        normals(points, triangles).astype(np.float32),
        uv.astype(np.float32),
    )


def normals(points: Array, triangles: NDArray) -> Array:
    """Compute unit normals (n, 3) of the points of triangles, weighted by area; up for unused points."""
    corners = np.asarray(points, np.float64)[triangles]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    total = np.stack(
        [np.bincount(triangles.ravel(), np.repeat(axis, 3), minlength=len(points)) for axis in faces.T],
        axis=-1,
    )
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.where(length > 0.0, total / np.where(length > 0.0, length, 1.0), (0.0, 0.0, 1.0))


def _arrival(shot: Shot) -> Array:
    """Return arrival times (rows, columns), s, of the terrain's grid; the northern row comes first."""
    ground = shot.ground
    row, column = np.meshgrid(*map(np.arange, ground.shape), indexing="ij")
    return ground.arrival_at(row.astype(float), column.astype(float))[::-1]


def encode_arrival(arrival: Array, first: float, last: float) -> tuple[bytes, float]:
    """Encode arrival times (s) as the red and green of a PNG; returns the seconds of a step too.

    A time after `last` counts as never, a time before `first` as `first`.
    """
    step = max(last - first, 1.0) / (_NEVER - 1)
    late = (arrival > last) | (arrival >= NEVER)
    counts = np.where(late, _NEVER, np.round((np.maximum(arrival, first) - first) / step)).astype(np.int64)
    shares = np.stack([counts // 256, counts % 256, np.zeros_like(counts)], axis=-1) / 255.0
    return sensor.encode_png(np.ascontiguousarray(shares, np.float32)), step
