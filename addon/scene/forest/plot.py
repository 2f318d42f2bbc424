"""Plots of a stand: the run's fuel grid, and procedural land round it out to the visible distance of trees.

So only `draw_distance` limits the forest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core.geo import LocalFrame
from firetwin_core.terrain import bilinear
from numpy.typing import NDArray

from ...run import areas, fuel_category
from ...shot.shot import Shot
from . import stand_structure, visibility, visible_cells

_CELL = 74.0  # m, least size of a cell beyond the run; its fuels have larger patches
_OTHER = 7919  # added to the seed, so that land beyond the run is not a copy of it


@dataclass(frozen=True)
class Plot:
    """A grid of cells that trees may stand in.

    Attributes
    ----------
    latitude, longitude
        (fy,), (fx,) degrees.
    canopy_fuel, elevation
        (fy, fx) kg/m2, m.
    mask
        (fy, fx) whether a camera may see a tree of the cell.
    area
        m2 of a cell.
    seed
        Seed of its trees.
    """

    latitude: NDArray[np.float64]
    longitude: NDArray[np.float64]
    canopy_fuel: NDArray
    elevation: NDArray
    mask: NDArray[np.bool_]
    area: float
    seed: int

    def places(self, frame: LocalFrame, chosen: NDArray[np.bool_]) -> NDArray[np.float64]:
        """Centres (n, 3) of chosen (fy, fx) cells in the scene, m."""
        row, column = np.nonzero(chosen)
        return frame.forward(self.latitude[row], self.longitude[column], self.elevation[row, column])


def plots(shot: Shot, height: float, reach: float) -> list[Plot]:
    """Return the run's plot, and a plot beyond it if cameras come close enough to see trees there.

    Parameters
    ----------
    height
        Height of the tallest tree, m.
    reach
        Greatest distance of trees from cameras, m.
    """
    run, seed = shot.run, shot.settings.seed
    axes, elevation = (run.fuel_latitude, run.fuel_longitude), shot.relief.fuel
    mask = visible_cells.visible_cells(shot, height, reach, *axes, elevation)
    fuel = stand_structure.with_lone(shot, fuel_category.canopy(run), *_lines(shot, *axes), mask)
    own = Plot(*axes, fuel, elevation, mask & (fuel > 0.0), float(np.prod(shot.ground.cell)), seed)
    beyond = _beyond(shot, height, reach)
    return [own] if beyond is None else [own, beyond]


def _beyond(shot: Shot, height: float, reach: float) -> Plot | None:
    ground = shot.ground
    fields = ground.fields
    if fields.margin == 0 or not _near_edge(shot, reach):
        return None
    axes, inside = [], []
    degrees = areas.metres_per_degree(ground.frame.latitude)
    for axis, cell, scale in zip((fields.latitude, fields.longitude), ground.cell, degrees, strict=True):
        low, high = axis[fields.margin], axis[-fields.margin - 1]
        step = max(cell, _CELL) / scale
        more = int(np.ceil(reach / max(cell, _CELL)))
        rim = np.arange(1, more + 1) * step
        within = np.linspace(low, high, max(round((high - low) / step), 1) + 1)
        line = np.concatenate([low - rim[::-1], within, high + rim])
        number = np.arange(len(line)) - more
        on_ground = (line >= axis[0] + 0.5 * step) & (line <= axis[-1] - 0.5 * step)
        axes.append(line[on_ground])
        inside.append(((number >= 0) & (number < len(within)))[on_ground])
    latitude, longitude = axes
    row, column = _lines(shot, latitude, longitude)
    fuel, elevation = (
        bilinear(field, row[:, None], column).astype(np.float32)
        for field in (fields.canopy_fuel, fields.elevation)
    )
    out = ~(inside[0][:, None] & inside[1][None, :])
    mask = visible_cells.visible_cells(shot, height, reach, latitude, longitude, elevation, out)
    fuel = stand_structure.with_lone(shot, fuel, row, column, mask)
    area = max(ground.cell[0], _CELL) * max(ground.cell[1], _CELL)
    shown = mask & (fuel > 0.0)
    return Plot(latitude, longitude, fuel, elevation, shown, area, shot.settings.seed + _OTHER)


def _lines(
    shot: Shot, latitude: NDArray[np.float64], longitude: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Fractional rows (fy,) and columns (fx,) of the terrain grid at a grid's lines."""
    row, _ = shot.ground.indices(latitude, np.full(len(latitude), longitude[0]))
    _, column = shot.ground.indices(np.full(len(longitude), latitude[0]), longitude)
    return row, column


def _near_edge(shot: Shot, reach: float) -> bool:
    """Return True if a camera sees trees beyond the run's boundary.

    A perspective camera sees them within `reach`, a satellite within its picture if pixels are small enough.
    """
    fields, cell = shot.ground.fields, shot.ground.cell
    for view in shot.paths:
        if not view.perspective and view.pixel > visibility.PIXEL:
            continue
        away = reach if view.perspective else float(np.hypot(*view.half))
        place = (view.position if view.perspective else view.target)[shot.filmed(view)]
        row, column = shot.ground.indices(*shot.ground.geodetic(place[:, 0], place[:, 1]))
        for at, count, size in zip((row, column), fields.elevation.shape, cell, strict=True):
            inner = min((at - fields.margin).min(), (count - 1 - fields.margin - at).min())
            if inner * size < away:
                return True
    return False
