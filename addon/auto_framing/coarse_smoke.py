"""Coarse smoke: a coarse flow in some moments of a shot, in which cameras are judged.

Smoke is drawn as in the shot's pictures. The nested domain starts shortly before each moment.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from threading import Event

import numpy as np
from firetwin_core import flow, volume
from numpy.typing import NDArray

from ..shot.shot import Shot
from ..smoke import coarse, domains, flow_frames, snapshots
from ..smoke.integrator import Integrator

_STEP = 2.0  # voxels, ray step
_OPAQUE = 8.0  # optical depth at which a ray ends

Array = NDArray[np.float64]


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
    solved = coarse.CoarseFlow(shot.with_settings(replace(shot.settings, cameras=())))
    if not shot.settings.smoke.enabled or not solved.boxes:
        return {}
    drawn = {}
    with tempfile.TemporaryDirectory(prefix="firetwin-") as folder:
        outer, nest = (
            replace(each, folder=Path(folder, str(number)))
            for number, each in enumerate(domains.on_ground(shot, solved.boxes))
        )
        for each in (outer, nest):
            each.folder.mkdir()
        painters = [
            flow_frames.Painter(solved.shot, layer, None if layer.fine else nest.box)
            for layer in coarse.layers([outer, nest])
        ]
        lead, integrator = shot.scale.time(coarse.LEAD), Integrator(solved.shot, [outer], Event(), 1)
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


def _paint(painters: list[flow_frames.Painter], frame: int) -> list[volume.Bricks]:
    """Draw the snapshots of a frame (from 1), all around."""
    outside, beyond = painters[0].bricks(frame, None, None)
    return [outside, painters[1].bricks(frame, None, None, beyond)[0]]
