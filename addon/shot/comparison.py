"""Comparison runs of a scene file: each is a separate shot with the first run's cameras and clock.

Camera paths follow the first run's terrain and fire. In another run a camera has the same position on the
Earth at the same UTC, for any grid, start and projection of that run. Heights refer to the datum of each
run's elevations, so the runs should share one.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from firetwin_core import geo
from firetwin_core.run import Run
from numpy.typing import NDArray

from ..progress import Progress, silent
from ..run import times
from . import passes
from .cameras.path import Path
from .settings import Camera
from .shot import Shot

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from .terrain.terrain import Terrain

_AXES = 1000.0 * np.vstack([np.zeros(3), np.eye(3)])  # m
_BURIED = 1.0  # m below another run's ground, from which on a warning is given


class ComparisonShot(Shot):
    """Shot of another run. Its cameras follow the paths of `first` and are named ``camera@run``.

    Attributes
    ----------
    first
        Shot of the first run, with the same cameras.
    """

    def __init__(self, first: Shot, label: str) -> None:
        self.first, self._label = first, label
        settings, shown = first.settings, first.frames
        begin, end = (times.utc(first.run, time) for time in (shown.first, shown.last))
        own = next(run for run in settings.runs if run.name == label)
        super().__init__(
            replace(
                settings,
                run=own.path,
                runs=(),
                time=replace(settings.time, start=begin, end=end if shown.count > 1 else None),
                render=replace(settings.render, passes=_uncompared(settings.render.passes)),
                cameras=tuple(_renamed(camera, label) for camera in settings.cameras),
            ),
            first.others[label],
        )
        self.cameras = tuple(_renamed(camera, label) for camera in first.cameras)
        self.others = first.others

    def input_hashes(self, leave_out: Collection[str] = (), progress: Progress = silent) -> dict[str, str]:
        """Hash the inputs of this run, and of the first run, which decide the camera paths."""
        flown = self.first.input_hashes((), progress)
        return super().input_hashes(leave_out, progress) | {
            f"first {name}": digest for name, digest in flown.items()
        }

    def for_camera(self, name: str) -> Shot:
        """Return a shot with this camera alone."""
        return ComparisonShot(self.first.for_camera(name.partition("@")[0]), self.label)

    def other_runs(self) -> dict[str, Run]:
        """Comparison runs of this shot, by name."""
        return {name: run for name, run in super().other_runs().items() if name != self.label} | {
            self.first.label: self.first.run
        }

    @property
    def label(self) -> str:
        """Name of the run."""
        return self._label

    def _paths(self, ground: Terrain) -> list[Path]:
        pairs = zip(self.first.paths, self.settings.cameras, strict=True)
        return [carried(path, camera, self.first.local_frame, self.local_frame) for path, camera in pairs]

    def warnings(self) -> list[str]:
        """Warnings about this run in comparison with the first."""
        messages = []
        if self.run.vertical != self.first.run.vertical:
            messages.append(
                f'heights of run "{self.label}" are {self.run.vertical} and heights of the first are '
                f"{self.first.run.vertical}: cameras are as far off over its ground as the geoid is"
            )
        for view in self.perspective_paths:
            ground = self.ground.up(*view.position[:, :2].T)
            depth = float(np.max(ground - view.position[:, 2]))
            if depth > _BURIED:
                messages.append(f'camera "{view.camera.name}" is up to {depth:,.0f} m under the ground there')
        return messages


def for_view(shot: Shot, view: str) -> Shot:
    """Shot of one camera: of the first run, or ``camera@run`` of another."""
    name, _, label = view.partition("@")
    return for_run(shot.for_camera(name), label)


def for_views(shot: Shot, views: Sequence[str]) -> list[Shot]:
    """Return the shots of views that are built separately; without views the shot of all cameras."""
    return [for_view(shot, view) for view in views] or [shot]


def for_run(shot: Shot, label: str) -> Shot:
    """Shot with all its cameras of the run with this name; itself without a name."""
    return ComparisonShot(shot, label) if label else shot


def carried(path: Path, camera: Camera, here: geo.LocalFrame, there: geo.LocalFrame) -> Path:
    """Transform a path to another local frame, with positions and directions fixed to the Earth."""
    corners = there.forward(*here.reverse(_AXES))
    turn = (corners[1:] - corners[0]).T / 1000.0  # columns: axes of `here` in `there`

    def moved(points: NDArray[np.float64]) -> NDArray[np.float64]:
        return corners[0] + points @ turn.T

    return replace(
        path,
        camera=camera,
        position=moved(path.position),
        rotation=turn @ path.rotation,
        target=moved(path.target),
        hidden=None,
    )


def _renamed(camera: Camera, label: str) -> Camera:
    """Rename a camera, and the one that it follows, for another run."""
    follows = getattr(camera.rig, "follows", "")
    rig = replace(camera.rig, follows=passes.view_of(follows, label)) if follows else camera.rig
    name = passes.view_of(camera.name, label)
    return replace(camera, name=name, rig=rig, passes=_uncompared(camera.passes))


def _uncompared(names: tuple[str, ...]) -> tuple[str, ...]:
    """Replace passes that compare runs by the passes that they are made from."""
    return passes.in_other_runs(names) or names


def caption(shot: Shot, frame: int) -> list[str]:
    """Caption: time of a frame, and a note on synthetic runs."""
    runs = [shot.run, *shot.others.values()]
    made_up = sum(run.synthetic for run in runs)
    note = ["synthetic" if made_up == len(runs) else f"{made_up} of {len(runs)} runs synthetic"]
    return [*(note if made_up else []), times.text(shot.utc(frame), shot.settings.time.zone)]
