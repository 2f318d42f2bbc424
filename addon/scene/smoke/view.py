"""Smoke as the cameras of a shot see it: how fine it must be, and where none of it is needed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core import volume

from ...shot import passes, sun
from ...shot.settings import Camera, Settings
from ...shot.shot import Shot

_NEAR, _BEHIND = 0.1, 25_000.0  # part of the fire's distance, and m beyond it, between which smoke shows
STEP_DEPTH = 0.8  # optical depth of a step through thick smoke; much longer steps lose smoke


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
        Of thick smoke, 1/m; see STEP_DEPTH.
    """

    voxel: float
    step: float
    extinction: float


def resolution(shot: Shot) -> Resolution:
    """The scene file's voxel size and extinction, where it gives them, else those for the cameras."""
    smoke = shot.settings.smoke
    voxel = smoke.voxel_size or float(np.clip(70.0 * (shot.fire_distance / 4000.0) ** 0.4, 50.0, 160.0))
    extinction = smoke.extinction or float(np.clip(STEP_DEPTH / (1.2 * voxel), 0.009, 0.03))
    return Resolution(voxel, STEP_DEPTH / extinction, extinction)


def span(shot: Shot) -> tuple[float, float]:
    """Distances from the cameras (m) between which smoke shows; the far side of old smoke may lie beyond."""
    return max(_NEAR * shot.fire_distance, 1.0), shot.fire_distance + _BEHIND


def shot_frames(shot: Shot) -> list[int]:
    """Frames whose smoke some picture shows; all of them where there is no camera."""
    cameras = shot.settings.cameras
    if not cameras:
        return list(range(1, shot.frames.count + 1))
    shown = (shot.frames_of(camera) for camera in cameras if _shows_smoke(shot.settings, camera))
    return sorted({frame for frames in shown for frame in frames})


def _shows_smoke(settings: Settings, camera: Camera) -> bool:
    """Whether a camera's passes, or those that they are made from, show smoke."""
    return any(_sees_smoke(each) for each in passes.of_camera(settings, camera))


def _sees_smoke(each: passes.Pass) -> bool:
    return "smoke" not in each.leaves_out or any(_sees_smoke(passes.known()[name]) for name in each.needs)


class Sights:
    """What the cameras see of the smoke, frame by frame, whatever they record of it."""

    def __init__(self, shot: Shot) -> None:
        self.shot = shot
        self.frames = [set(shot.frames_of(path.camera)) for path in shot.paths]
        run = shot.run
        ground = shot.local_frame.forward_grid(
            run.latitude, run.longitude, np.nan_to_num(run.elevation.astype(np.float64))
        )
        self.floor = float(ground[..., 2].min())

    def of(self, frame: int) -> volume.Sight | None:
        """What counts in a frame; None where all does: a satellite looks, or no camera at all."""
        shot = self.shot
        looking = [path for path, frames in zip(shot.paths, self.frames, strict=True) if frame in frames]
        if not looking or not all(path.perspective for path in looking):
            return None
        return volume.Sight(
            [path.position[frame - 1] for path in looking],
            [path.rotation[frame - 1] for path in looking],
            [2.0 * np.arctan(path.half) for path in looking],
            list(sun.direction(*shot.sun(shot.frames.time(frame)))),
            self.floor,
        )
