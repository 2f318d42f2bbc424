"""Buildings of stations at true size: outlines of the user, or a plain hall with three gates."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import owned
from ...blender.owned import Stage
from ...geometry.polygons import area
from ...run import areas
from ...run.buildings import Footprint, place_on_ground
from ...shot.shot import Shot
from ...shot.stations.station_signs import Sign
from ..terrain import buildings, windows
from ..terrain.buildings import Blocks

_LONG, _WIDE, _HIGH = 24.0, 15.0, 6.0  # m, a plain hall for three engines (assumed); height of all walls
_ON_DUTY = 0.6  # share of a station's windows that are lit at any hour of the night (assumed)
_GATE, _GATE_HIGH, _OUT = 4.3, 4.3, 0.06  # m, width and height of a gate, and its offset from the wall
_WALL, _ROOF, _DOOR = (0.17, 0.13, 0.10), (0.105, 0.105, 0.110), (0.14, 0.014, 0.010)  # by eye

Array = NDArray[np.float64]


def build(
    shot: Shot, stage: Stage, collection: bpy.types.Collection, shown: Sequence[Sign]
) -> bpy.types.Object | None:
    """Build "Firetwin Halls" at the stations; None without stations."""
    rings = [hall(shot, each) if each.footprint is None else _metres(shot, each.footprint) for each in shown]
    outlines = [Footprint(ring, (), _HIGH) for ring in rings]
    blocks, night = Blocks(), windows.shines(shot)
    for sign, block in zip(
        shown, place_on_ground(outlines, lambda place: shot.ground.up(*place.T)), strict=True
    ):
        blocks.add(block, _ROOF, _WALL)
        if night:
            blocks.light(block, shot, _ON_DUTY)
        if sign.footprint is None:
            _gates(blocks, block.footprint.outer, block.roof - _HIGH)
    if not blocks.corners:
        return None
    data = blocks.mesh("Firetwin Halls", shot, buildings.material(shot, stage, "Firetwin Halls"))
    return owned.add(collection, "Halls", data)


def hall(shot: Shot, sign: Sign) -> Array:
    """Return the corners (4, 2) of a plain hall centred on the station, with gates facing south, m."""
    x, y, _ = shot.ground.point(sign.latitude, sign.longitude)[0]
    half = 0.5 * np.array([_LONG, _WIDE])
    return np.array([x, y]) + half * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])


def _metres(shot: Shot, outline: Array) -> Array:
    """Convert an outline to scene coordinates (n, 2), m, counter-clockwise."""
    longitude = areas.turned(outline[:, 0], float(np.mean(shot.ground.fields.longitude)))
    ring = shot.ground.point(outline[:, 1], longitude)[:, :2]
    return ring if area(ring) >= 0.0 else ring[::-1]


def _gates(blocks: Blocks, ring: Array, floor: float) -> None:
    """Append three gates on the south wall."""
    (left, south), right = ring[0], ring[1][0]
    for k in range(3):
        middle = left + (right - left) * (k + 0.5) / 3.0
        corners = [
            (middle + x * _GATE, south - _OUT, floor + z * _GATE_HIGH)
            for x, z in ((-0.5, 0.0), (0.5, 0.0), (0.5, 1.0), (-0.5, 1.0))
        ]
        blocks.face(np.array(corners), _DOOR)
