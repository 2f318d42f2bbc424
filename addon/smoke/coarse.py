"""Coarse flow: the shot's flow on wider cells, solved in seconds, as a preview and to judge cameras.

Heat, air and domain are the shot's. A nested domain around the fire starts shortly before the first moment
that is drawn, so that smoke begins at the flames. Needs no Blender.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, replace

import numpy as np

from ..progress import Progress, silent
from ..shot.fire.smoke_scale import Scale
from ..shot.shot import Shot
from . import domains, flow_frames
from .domains import Box, Domain
from .flow import Flow

LEAD = 200.0
"""s, on cells of `smoke_scale.REFERENCE`, that the nest is solved before a moment."""
COLUMNS = (9000, 24_000)
"""Columns of the coarse domain and of its nest at most: three seconds of work."""
LAPSE_COLUMNS = 20_000
"""Columns of the domain of a time lapse at most."""
_WIDER = (2, 3, 4, 6, 8)  # cells of the shot's domain along a coarse cell: the first with few enough columns
_FINER = (3, 2)  # cells of the nest along a coarse cell: the first with few enough columns
_SPIN_UP = 0.6  # of the shot's, as smoke far from the fire is before no camera (assumed)
_LONGER = 2  # steps of the shot's domain in a coarse step at most; longer ones are unstable
_NARROWEST = 20  # coarse cells along a side at least, which the sponge at the sides needs
_LOW = 8  # lowest levels, not joined; above, two become one
_ROUND = 4  # coarse cells around the heat in the nest
_EDGE = 2  # coarse cells between the nest and the sides of the coarse domain at least
_VOXELS = (1.0, 0.5)  # edge of a drawn voxel over a cell, outside of the nest and in it


@dataclass(frozen=True)
class _CoarseScale(Scale):
    """Scale of the shot with longer steps, for wider cells."""

    @property
    def step(self) -> float:
        return _LONGER * super().step


class CoarseFlow(Flow):
    """Flow of a shot on wider cells, in a coarse domain and its nest."""

    lead = LEAD

    def __init__(self, shot: Shot, progress: Progress = silent) -> None:
        super().__init__(with_longer_steps(shot), progress)
        self._around = domains.outer_box(shot)

    @functools.cached_property
    def boxes(self) -> list[Box]:
        """Boxes of the coarse domain and of its nest; none without fire."""
        if self._around is None:
            return []
        box = _coarsen(self._around, COLUMNS[0])
        return [box, _nest_box(self.shot, box)]


class LapseFlow(CoarseFlow):
    """Coarse flow of a time lapse, without a nest: hours of a single domain cost less."""

    @functools.cached_property
    def boxes(self) -> list[Box]:
        """Box of the domain; none without fire."""
        return [] if self._around is None else [_coarsen(self._around, LAPSE_COLUMNS)]


def with_longer_steps(shot: Shot) -> Shot:
    """Return a shot for a coarse flow: with longer steps and a shorter spin-up."""
    smoke = replace(shot.settings.smoke, spin_up=_SPIN_UP * shot.spin_up)
    coarse = shot.with_settings(replace(shot.settings, smoke=smoke))
    coarse.scale = _CoarseScale(shot.scale.cell, nested=False)
    return coarse


def layers(solved: list[Domain], voxel: float = 0.0) -> list[flow_frames.Layer]:
    """List the volume layers of a coarse flow, over ground that is sampled once for each cell.

    Parameters
    ----------
    voxel
        Edge length of a voxel in the nest, m; 0: by its cells.
    """
    if not solved:
        return []
    outer, *nests = solved
    if not nests:
        step = outer.box.spacing
        return [flow_frames.Layer("smoke", outer, voxel or _VOXELS[0] * step, fine=False, ground_step=step)]
    (nest,) = nests
    steps = outer.box.spacing, nest.box.spacing
    far, near = (part * step for part, step in zip(_VOXELS, steps, strict=True))
    return [
        flow_frames.Layer("far", outer, max(voxel, far), fine=False, ground_step=steps[0]),
        flow_frames.Layer("smoke", nest, voxel or near, fine=True, ground_step=steps[1]),
    ]


def _coarsen(box: Box, columns: int) -> Box:
    """Join cells of a box to at most so many columns, and its upper levels."""
    allowed = [n for n in _WIDER if min(box.shape) >= n * _NARROWEST]
    wider = next((n for n in allowed if math.prod(box.shape) <= n * n * columns), allowed[-1])
    rows, columns = (count // wider for count in box.shape)
    levels = (*box.levels[:_LOW], *box.levels[_LOW::2])
    return Box(levels, (rows, columns), wider * box.spacing, box.corner)


def _nest_box(shot: Shot, box: Box) -> Box:
    """Return a box of finer cells around the heat of the shot, in a coarse box."""
    corner, most = np.array(box.corner), np.array(box.shape[::-1]) - _EDGE
    low, high = ((each - corner) / box.spacing for each in domains.heat_bounds(shot))
    low = np.clip(np.floor(low) - _ROUND, _EDGE, most - 1)
    high = np.clip(np.ceil(high) + _ROUND, low + 1, most)
    columns, rows = (int(each) for each in high - low)
    finer = next((n for n in _FINER if n * n * columns * rows <= COLUMNS[1]), _FINER[-1])
    corner += low * box.spacing
    shape = finer * rows, finer * columns
    return Box(box.levels, shape, box.spacing / finer, (float(corner[0]), float(corner[1])))
