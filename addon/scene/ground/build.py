"""The ground: one continuous mesh, finer near the cameras, with its material's inputs as attributes."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...blender import owned
from ...blender.owned import Stage
from ...shot import noise
from ...shot.ground import Ground, bilinear
from ...shot.shot import Shot
from ..forest.stand import Stand
from . import grid_mesh, material

_RELIEF = 30.0  # m; so far up and down a cell's relief may reach
_LIMIT = 900_000  # quads of the finer part; more than this and its edge moves nearer


def build(shot: Shot, stage: Stage, grown: Stand | None) -> bpy.types.Object:
    """Build "Firetwin Ground".

    Its mesh carries float point attributes: `arrival_time` (s, 1e9 where never), `burn_time` (arrival
    continued a little past the last perimeter), `burned` (1 inside it), `canopy_fuel`, `surface_fuel`
    (kg/m2), `bare` (part without fuel), `water` (1 on lakes), `elevation` (m), `stand` (part of
    the forest that is drawn tree by tree) and `detail` (1 near cameras).
    """
    collection, ground = stage.part("Ground"), shot.ground
    mesh = grid_mesh.graded(levels(shot))
    coarse = _positions(ground, mesh, 0.0)
    detail = ground.detail(*coarse.T)
    positions = _positions(ground, mesh, detail)
    data = bpy.data.meshes.new("Firetwin Ground")
    _fill(data, positions, mesh)
    attributes = _attributes(ground, mesh, detail)
    attributes["stand"] = _stand_cover(shot, positions, grown)
    for name, values in attributes.items():
        data.attributes.new(name, "FLOAT", "POINT").data.foreach_set("value", values.astype(np.float32))
    data.materials.append(material.build(shot, stage))
    return owned.add(collection, "Ground", data)


def levels(shot: Shot) -> NDArray[np.int64]:
    """How often each cell of the grid is halved: to `near_spacing` near cameras, less with distance."""
    ground, settings = shot.ground, shot.settings.ground
    rows, columns = ground.shape
    level = np.zeros((rows - 1, columns - 1), np.int64)
    finest = max(int(np.ceil(np.log2(max(ground.cell) / settings.near_spacing))), 0)
    if not shot.near or finest == 0 or settings.near_radius <= 0.0:
        return level
    row, column = np.meshgrid(np.arange(rows - 1) + 0.5, np.arange(columns - 1) + 0.5, indexing="ij")
    latitude, longitude = ground.places(row.ravel(), column.ravel())
    centre = ground.frame.forward(latitude, longitude, bilinear(ground.fields.elevation, row, column).ravel())
    distance = shot.sights.distance(centre)
    close = np.flatnonzero(distance < settings.near_radius)
    close = close[shot.sights.seen(centre[close], _reach(ground).ravel()[close], shadows=True)]
    ratio = distance[close] / settings.near_radius
    while True:  # spacing grows with distance: halved at 0.5, again at 0.25 of the radius
        wanted = np.clip(finest - np.ceil(np.log2(np.maximum(ratio, 1.0e-3) / 0.3)), 1, finest).astype(
            np.int64
        )
        wanted[ratio >= 1.0] = 0
        if np.sum(4**wanted) <= _LIMIT or len(ratio) == 0:
            break
        ratio = ratio * 1.2
    level.ravel()[close] = wanted
    margin = ground.fields.margin
    if margin:  # the apron is never seen close up
        inner = np.zeros_like(level)
        inner[margin:-margin, margin:-margin] = level[margin:-margin, margin:-margin]
        level = inner
    return level


def _reach(ground: Ground) -> NDArray[np.float64]:
    """How far (rows, columns) a cell reaches from the middle of its four points, however it is drawn, m."""
    corners = np.lib.stride_tricks.sliding_window_view(ground.fields.elevation, (2, 2))
    return np.hypot(0.5 * np.hypot(*ground.cell), np.ptp(corners, axis=(2, 3))) + _RELIEF


def _positions(ground: Ground, mesh: grid_mesh.GridMesh, detail: NDArray[np.float64] | float) -> NDArray:
    latitude, longitude = ground.places(mesh.row, mesh.column)
    return ground.frame.forward(latitude, longitude, ground.height(mesh.row, mesh.column, detail))


def _attributes(ground: Ground, mesh: grid_mesh.GridMesh, detail: NDArray) -> dict[str, NDArray]:
    fields, at = ground.fields, (mesh.row, mesh.column)
    return {
        "arrival_time": ground.arrival_at(*at),
        "burn_time": bilinear(np.minimum(ground.burn_time, 1.0e7), *at),
        "burned": bilinear(ground.burned, *at),
        "canopy_fuel": bilinear(fields.canopy_fuel, *at),
        "surface_fuel": bilinear(fields.surface_fuel, *at),
        "bare": bilinear(ground.bare, *at),
        "water": bilinear(ground.water, *at),
        "elevation": ground.height(*at, detail),
        "detail": noise.smoothstep(0.0, 1.0, detail),
    }


def _stand_cover(shot: Shot, positions: NDArray, grown: Stand | None) -> NDArray[np.float64]:
    """Part of the forest's trees that stands there one by one, so that the ground need not draw it."""
    cover = np.zeros(len(positions))
    if grown is None or not shot.near:
        return cover
    distance = shot.sights.distance(positions)
    close = np.flatnonzero(distance < grown.radius)
    cover[close] = grown.coverage(distance[close])
    return cover


def _fill(data: bpy.types.Mesh, positions: NDArray[np.float64], mesh: grid_mesh.GridMesh) -> None:
    """Write vertices and polygons into an empty mesh, smooth shaded."""
    data.vertices.add(len(positions))
    data.vertices.foreach_set("co", positions.astype(np.float32).ravel())
    data.loops.add(len(mesh.loops))
    data.loops.foreach_set("vertex_index", mesh.loops)
    data.polygons.add(len(mesh.starts))
    data.polygons.foreach_set("loop_start", mesh.starts)
    data.update(calc_edges=True)
