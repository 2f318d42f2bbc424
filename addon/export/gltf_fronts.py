"""glTF fronts: lines on the ground, one node for each time, with the time and the area in its extras."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..ellipsoid import metres_per_degree
from ..run import times
from ..shot.shot import Shot
from .fronts import DatedFront
from .gltf_document import Document
from .scene_content import Array

COLOUR = (1.0, 0.25, 0.02)
"""Linear colour of the lines, by eye."""
_STEP = 120.0  # m between points of a line, so that it follows the ground
_LINES = 1  # mode of a primitive: pairs of points


def add(document: Document, shot: Shot, dated_fronts: Sequence[DatedFront], start: float) -> None:
    """Append fronts.

    Parameters
    ----------
    start
        Model time of the run's start, s.
    """
    if not dated_fronts:
        return
    document.use("KHR_materials_unlit")
    material = document.material("front", COLOUR, extensions={"KHR_materials_unlit": {}})
    parent = document.node("fronts")
    for front in dated_fronts:
        points, pairs = lines(shot, front.lines)
        name = f"front {times.iso(front.begin)}"
        part = {
            "attributes": {"POSITION": document.vectors(points, bounds=True)},
            "indices": document.indices(pairs, len(points)),
            "mode": _LINES,
            "material": material,
        }
        extras: dict[str, Any] = {
            "time_utc": times.iso(front.begin),
            "time_s": front.time - start,
            "area_m2": front.area,
        }
        mesh = document.add("meshes", {"name": name, "primitives": [part]})
        document.node(name, parent, mesh=mesh, extras=extras)


def lines(shot: Shot, rings: Sequence[Array]) -> tuple[Array, NDArray[np.int64]]:
    """Lay closed lines of degrees on the ground: scene points (n, 3), m, and pairs of numbers (m, 2)."""
    dense = [_dense(ring) for ring in rings]
    ends = np.cumsum([len(ring) for ring in dense])
    first = np.arange(ends[-1])
    pairs = np.column_stack([first, first + 1])
    longitude, latitude = np.concatenate(dense).T
    return shot.ground.point(latitude, longitude), np.delete(pairs, ends - 1, axis=0)


def _dense(line: Array) -> Array:
    """Insert points, so that neighbours are at most `_STEP` apart."""
    north, east = metres_per_degree(float(line[:, 1].mean()))
    length = np.hypot(*(np.diff(line, axis=0) * (east, north)).T)
    parts = np.maximum(np.ceil(length / _STEP), 1.0).astype(int)
    share = np.concatenate([np.arange(count) / count for count in parts])
    before = np.repeat(np.arange(len(parts)), parts)
    return np.vstack([line[before] + share[:, None] * (line[before + 1] - line[before]), line[-1:]])
