"""Smoke as the cameras of a shot see it: how fine it must be, and where none of it is needed."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from firetwin_core import volume
from firetwin_core.run import Run

from .. import frame_list
from ..project import Camera, Project
from ..times import frame_times
from . import burning, paths, sun
from .frame import local_frame

_NEAR, _BEHIND = 0.1, 25_000.0  # part of the fire's distance, and m beyond it, between which smoke shows
_STEP_DEPTH = 0.8  # optical depth of a step through thick smoke; much longer steps lose smoke


@dataclass(frozen=True)
class Resolution:
    """How finely smoke is drawn, from the distance of the nearest camera.

    Attributes
    ----------
    voxel
        Edge of a voxel, m.
    step
        Step along rays through the smoke, m.
    extinction
        Of thick smoke, 1/m; see _STEP_DEPTH.
    """

    voxel: float
    step: float
    extinction: float


def resolution(project: Project, run: Run) -> Resolution:
    """The scene file's voxel size and extinction, where it gives them, else those for the cameras."""
    distance = _distance(project, run)
    voxel = project.smoke.voxel_size or float(np.clip(70.0 * (distance / 4000.0) ** 0.4, 50.0, 160.0))
    extinction = project.smoke.extinction or float(np.clip(_STEP_DEPTH / (1.2 * voxel), 0.009, 0.03))
    return Resolution(voxel, _STEP_DEPTH / extinction, extinction)


def span(project: Project, run: Run) -> tuple[float, float]:
    """Distances from the cameras (m) between which smoke shows; the far side of old smoke may lie beyond."""
    distance = _distance(project, run)
    return max(_NEAR * distance, 1.0), distance + _BEHIND


def shot_frames(project: Project) -> list[int]:
    """Frames that some camera sees smoke in: those of its visible pass."""
    if not project.cameras:
        return list(range(1, project.time.frames + 1))
    return sorted({frame for camera in project.cameras for frame in _frames(project, camera)})


class Sights:
    """What the cameras see of the smoke, frame by frame."""

    def __init__(self, project: Project, run: Run) -> None:
        self.run = run
        self.times = frame_times(project, run)
        self.paths = paths.paths(project, run)
        self.frames = [set(_frames(project, path.camera)) for path in self.paths]
        ground = local_frame(run).forward_grid(
            run.latitude, run.longitude, np.nan_to_num(run.elevation.astype(np.float64))
        )
        self.floor = float(ground[..., 2].min())

    def of(self, frame: int) -> volume.Sight | None:
        """What counts in a frame; None where all does: a satellite looks, or no camera at all."""
        looking = [path for path, frames in zip(self.paths, self.frames, strict=True) if frame in frames]
        if not looking or not all(path.perspective for path in looking):
            return None
        return volume.Sight(
            [path.position[frame - 1] for path in looking],
            [path.rotation[frame - 1] for path in looking],
            [2.0 * np.arctan(path.half) for path in looking],
            list(sun.direction(*sun.at(self.run, float(self.times[frame - 1])))),
            self.floor,
        )


def _frames(project: Project, camera: Camera) -> list[int]:
    """Frames in which a camera takes visible pictures."""
    shows = "rgb" in (camera.passes or project.render.passes)
    return frame_list.parse(camera.frames, project.time.frames) if shows else []


@functools.lru_cache(maxsize=8)
def _distance(project: Project, run: Run) -> float:
    """How near (m) cameras come to the fire: nearer than nine tenths of it in their nearest frame."""
    times = frame_times(project, run)
    burning_cells = burning.cells(run, times[0] - 1800.0, times[-1] + 1.0)
    if not project.cameras or len(burning_cells.arrival) == 0:
        return 20_000.0
    nearest = []
    for view in paths.paths(project, run):
        if view.perspective:
            nearest.append(float(np.percentile(view.distance(burning_cells.position[::5]), 10.0)))
        else:  # as if seen by a 28 mm lens with pixels of the same size on the ground
            nearest.append(2.0 * view.half[0] * 28.0 / paths.SENSOR)
    return min(nearest)
