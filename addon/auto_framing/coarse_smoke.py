"""Coarse smoke: the shot's flow on wider cells, solved in seconds, in which cameras are judged.

Heat, air and domain are the shot's, and smoke is drawn as in its pictures. A nested domain around the fire
starts shortly before each moment that is drawn, so that smoke begins at the flames.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Event

import numpy as np
from firetwin_core import flow, volume
from numpy.typing import NDArray

from ..shot.fire.smoke_scale import Scale
from ..shot.shot import Shot
from ..smoke import domains, flow_frames, snapshots
from ..smoke.domains import Box, Domain
from ..smoke.integrator import Integrator

_WIDER = (2, 3, 4, 6, 8)  # cells of the shot's domain along a coarse cell: the first with few enough columns
_FINER = (3, 2)  # cells of the nest along a coarse cell: the first with few enough columns
_COLUMNS = (9000, 24_000)  # columns of the coarse domain and of its nest at most: three seconds of work
_SPIN_UP = 0.6  # of the shot's, as smoke far from the fire is before no camera (assumed)
_LONGER = 2  # steps of the shot's domain in a coarse step at most; longer ones are unstable
_NARROWEST = 20  # coarse cells along a side at least, which the sponge at the sides needs
_LOW = 8  # lowest levels, not joined; above, two become one
_ROUND = 4  # coarse cells around the heat in the nest
_EDGE = 2  # coarse cells between the nest and the sides of the coarse domain at least
_LEAD = 200.0  # s, on cells of `smoke_scale.REFERENCE`, that the nest is solved before a moment
_VOXELS = (1.0, 0.5)  # edge of a drawn voxel over a cell, outside of the nest and in it
_STEP = 2.0  # voxels, ray step
_OPAQUE = 8.0  # optical depth at which a ray ends

Array = NDArray[np.float64]


@dataclass(frozen=True)
class _CoarseScale(Scale):
    """Scale of the shot with longer steps, for wider cells."""

    @property
    def step(self) -> float:
        return _LONGER * super().step


class CoarseSmoke:
    """Smoke of a shot in some of its frames.

    Parameters
    ----------
    frames
        Frames from 0, ascending.
    """

    def __init__(self, shot: Shot, frames: Iterable[int]) -> None:
        self._frames = [int(frame) for frame in frames]
        self._bricks = _draw(shot, sorted(set(self._frames)))

    def depth(self, moment: int, eye: Array, place: Array) -> Array:
        """Compute the optical depth (n,) between a camera (3,) and points (n, 3), m.

        Parameters
        ----------
        moment
            Index of the frame among those that were given.
        """
        bricks = self._bricks.get(self._frames[moment])
        if len(place) == 0 or not bricks:
            return np.zeros(len(place))
        away = place - eye
        far = np.maximum(np.linalg.norm(away, axis=-1), 1e-6)
        rays = eye, away / far[:, None], far
        return volume.optical_depth(bricks, *rays, _STEP, _OPAQUE).astype(np.float64)


def _draw(shot: Shot, frames: list[int]) -> dict[int, list[volume.Bricks]]:
    """Solve and draw the smoke in frames from 0; empty without fire or without smoke."""
    around = domains.outer_box(shot)
    if around is None or not shot.settings.smoke.enabled:
        return {}
    smoke = replace(shot.settings.smoke, spin_up=_SPIN_UP * shot.spin_up)
    coarse = shot.with_settings(replace(shot.settings, cameras=(), smoke=smoke))
    coarse.scale = _CoarseScale(shot.scale.cell, nested=False)
    box, drawn = _coarsen(around), {}
    with tempfile.TemporaryDirectory(prefix="firetwin-") as folder:
        outer, nest = (_domain(shot, box, each, Path(folder)) for each in (box, _nest_box(shot, box)))
        painters = _painters(coarse, outer, nest)
        lead, integrator = shot.scale.time(_LEAD), Integrator(coarse, [outer], Event(), 1)
        integrator.domains.append(nest)  # so that it has sources; it starts below
        for frame in frames:
            time = float(shot.frames.times[frame])
            if time - integrator.now > 2.0 * lead:
                del integrator.solvers[1:]
            if len(integrator.solvers) == 1:
                _advance(integrator, time - lead)
                integrator.start_nest(nest)
            _advance(integrator, time)
            for domain, solver in zip((outer, nest), integrator.solvers, strict=True):
                snapshots.save(domain.snapshot_path(frame + 1), solver, flow.Drift(solver))
            drawn[frame] = _paint(painters, frame + 1)
    return drawn


def _advance(integrator: Integrator, time: float) -> None:
    """Advance to a model time (s) in even steps, with the sources of their times."""
    left = time - integrator.now
    count = math.ceil(left / integrator.scale.step - 1e-9)
    for _ in range(count):
        integrator.find_step()
        integrator.advance(left / count)


class _CoarsePainter(flow_frames.Painter):
    """Painter over ground that is sampled once for each cell."""

    @property
    def _surface_step(self) -> float:
        return self.layer.domain.box.spacing


def _painters(shot: Shot, outer: Domain, nest: Domain) -> list[_CoarsePainter]:
    """Painters of both domains."""
    far, near = (part * domain.box.spacing for part, domain in zip(_VOXELS, (outer, nest), strict=True))
    return [
        _CoarsePainter(shot, flow_frames.Layer("far", outer, far, fine=False), nest.box),
        _CoarsePainter(shot, flow_frames.Layer("smoke", nest, near, fine=True), None),
    ]


def _paint(painters: list[_CoarsePainter], frame: int) -> list[volume.Bricks]:
    """Draw the snapshots of a frame (from 1), all around."""
    outside, beyond = painters[0].bricks(frame, None, None)
    return [outside, painters[1].bricks(frame, None, None, beyond)[0]]


def _domain(shot: Shot, outer: Box, box: Box, folder: Path) -> Domain:
    """Domain in a box, smoothed like the shot's domains, with its snapshots in a new folder."""
    ground = domains.smooth_ground(shot, outer, 2)
    mean = float(ground.mean())
    if box is not outer:
        ground = domains.smooth_ground(shot, box, 8)
    folder = folder / f"{box.spacing:g}"
    folder.mkdir()
    return Domain(box, ground, mean, outer.levels[-1], folder, shot.scale)


def _coarsen(box: Box) -> Box:
    """Join cells of a box, and its upper levels."""
    allowed = [n for n in _WIDER if min(box.shape) >= n * _NARROWEST]
    wider = next((n for n in allowed if math.prod(box.shape) <= n * n * _COLUMNS[0]), allowed[-1])
    rows, columns = (count // wider for count in box.shape)
    levels = (*box.levels[:_LOW], *box.levels[_LOW::2])
    return Box(levels, (rows, columns), wider * box.spacing, box.corner)


def _nest_box(shot: Shot, box: Box) -> Box:
    """Box of finer cells around the heat of the shot, in a coarse box."""
    corner, most = np.array(box.corner), np.array(box.shape[::-1]) - _EDGE
    low, high = ((each - corner) / box.spacing for each in domains.heat_bounds(shot))
    low = np.clip(np.floor(low) - _ROUND, _EDGE, most - 1)
    high = np.clip(np.ceil(high) + _ROUND, low + 1, most)
    columns, rows = (int(each) for each in high - low)
    finer = next((n for n in _FINER if n * n * columns * rows <= _COLUMNS[1]), _FINER[-1])
    corner += low * box.spacing
    shape = finer * rows, finer * columns
    return Box(box.levels, shape, box.spacing / finer, (float(corner[0]), float(corner[1])))
