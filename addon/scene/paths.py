"""Where cameras are and what they see in every frame, without Blender."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from firetwin_core.run import Run
from numpy.typing import ArrayLike, NDArray

from ..errors import input_error
from ..project import Camera, CameraKey, Project
from . import clock, noise, targets
from .ground import Ground

SENSOR = 36.0  # mm, width of the film
SATELLITE_HEIGHT = 60_000.0  # m above the ground, over any smoke
_HIGHEST = 1500.0  # m; a camera is not raised more than this to see over a ridge
_VIEWS = 64  # at most this many moments of a path are asked what they see

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Path:
    """A camera's way through the shot.

    Attributes
    ----------
    position
        (frames, 3) metres in the scene.
    rotation
        (frames, 3, 3) matrices whose columns are the camera's right, up and back.
    half
        Tangents of half the horizontal and vertical angle of view; for a satellite half the width and height
        of its picture in metres.
    """

    camera: Camera
    position: Array
    rotation: Array
    target: Array
    half: tuple[float, float]

    @property
    def perspective(self) -> bool:
        """Whether lines of sight meet in the camera."""
        return self.camera.kind != "satellite"

    def sees(self, points: ArrayLike, margin: float = 150.0, reach: float = np.inf) -> NDArray[np.bool_]:
        """Which of the points (n, 3) are in view in any frame, within `reach`; `margin` (m) widens the view.

        The margin also keeps what only throws its shadow into the picture.
        """
        points = np.asarray(points, np.float32)
        seen = np.zeros(len(points), bool)
        count = len(self.position)
        for frame in np.unique(np.linspace(0, count - 1, min(count, _VIEWS)).round().astype(int)):
            left = np.flatnonzero(~seen)
            local = (points[left] - self.position[frame].astype(np.float32)) @ self.rotation[frame].astype(
                np.float32
            )
            depth = -local[:, 2]
            scale = np.maximum(depth, 0.0) if self.perspective else 1.0
            inside = (depth > -margin) & ((local**2).sum(1) < reach**2)
            inside &= np.abs(local[:, 0]) <= scale * self.half[0] + margin
            inside &= np.abs(local[:, 1]) <= scale * self.half[1] + margin
            seen[left[inside]] = True
        return seen

    def distance(self, points: ArrayLike) -> NDArray[np.float32]:
        """Least distance (n,) in metres of points (n, 3) from the path."""
        points = np.asarray(points, np.float32)
        count = len(self.position)
        nearest = np.full(len(points), np.inf, np.float32)
        for frame in np.unique(np.linspace(0, count - 1, min(count, _VIEWS)).round().astype(int)):
            gap = points - self.position[frame].astype(np.float32)
            np.minimum(nearest, np.einsum("ij,ij->i", gap, gap), out=nearest)
        return np.sqrt(nearest)


def paths(project: Project, run: Run, ground: Ground | None = None) -> list[Path]:
    """Paths of all cameras of the project; with a detailed ground, cameras keep their height above that."""
    ground = ground or Ground(project, run)
    return [_path(project, run, ground, camera) for camera in project.cameras]


def eyes(views: list[Path], radius: float) -> Array:
    """(m, 3) places along perspective paths, a quarter of `radius` apart: where the ground needs detail."""
    kept: list[Array] = []
    for path in views:
        if not path.perspective:
            continue
        last = None
        for place in path.position:
            if last is None or np.linalg.norm(place - last) > 0.25 * radius:
                kept.append(place)
                last = place
    return np.array(kept).reshape(-1, 3)


def _path(project: Project, run: Run, ground: Ground, camera: Camera) -> Path:
    width, height = project.render.resolution
    if camera.kind == "satellite":
        return _satellite(project, run, ground, camera, height / width)
    if not camera.keys:
        raise input_error(project.path, 0, 0, f'camera "{camera.name}" has no keys: give it at least one')
    keys = sorted(camera.keys, key=lambda key: key.at)
    at = np.array([key.at for key in keys])
    moments = np.linspace(0.0, 1.0, project.time.frames) if project.time.frames > 1 else np.zeros(1)
    base = ground.point(*(_column(keys, name) for name in ("latitude", "longitude", "height")))
    position = np.stack([_smooth(at, base[:, axis], moments) for axis in range(3)], axis=-1)
    aims = [_aim(project, run, ground, key) for key in keys]
    target = _blend(at, np.array(aims), moments)
    short = _below(ground, position, 0.35 * _smooth(at, _column(keys, "height"), moments))
    if any(key.target != "point" for key in keys):  # nobody could know where the fire would be
        short = np.maximum(short, _hidden(ground, position, target))
    position[:, 2] += _eased(short)
    half = 0.5 * SENSOR / camera.focal_length
    return Path(camera, position, _look(position, target), target, (half, half * height / width))


def _satellite(project: Project, run: Run, ground: Ground, camera: Camera, aspect: float) -> Path:
    if camera.keys:
        latitude, longitude = camera.keys[0].latitude, camera.keys[0].longitude
    else:
        latitude, longitude = ground.frame.latitude, ground.frame.longitude
    place = ground.point(latitude, longitude)
    position = np.repeat(place + np.array([0.0, 0.0, SATELLITE_HEIGHT]), project.time.frames, axis=0)
    rotation = np.repeat(np.eye(3)[None], project.time.frames, axis=0)
    half = 0.5 * camera.swath
    target = np.repeat(place, project.time.frames, axis=0)
    return Path(camera, position, rotation, target, (half, half * aspect))


def _column(keys: list[CameraKey], name: str) -> Array:
    return np.array([getattr(key, name) for key in keys], np.float64)


def _smooth(at: Array, values: Array, moments: Array) -> Array:
    """Monotone cubic through (at, values), held outside (Fritsch and Butland 1984: no overshoot)."""
    if len(at) == 1:
        return np.full(len(moments), values[0])
    gap, delta = np.diff(at), np.diff(values)
    if np.any(gap <= 0.0):
        at, keep = np.unique(at, return_index=True)
        return _smooth(at, values[keep], moments)
    secant = delta / gap
    slope = np.zeros(len(at))
    if len(at) > 2:
        left, right = 2.0 * gap[1:] + gap[:-1], gap[1:] + 2.0 * gap[:-1]
        same = secant[:-1] * secant[1:] > 0.0
        safe = np.where(same, secant[:-1], 1.0), np.where(same, secant[1:], 1.0)
        slope[1:-1] = np.where(same, (left + right) / (left / safe[0] + right / safe[1]), 0.0)
    slope[0], slope[-1] = secant[0], secant[-1]
    t = np.clip(moments, at[0], at[-1])
    i = np.clip(np.searchsorted(at, t, "right") - 1, 0, len(gap) - 1)
    s = (t - at[i]) / gap[i]
    a, b = values[i], values[i + 1]
    ease = s * s * (3.0 - 2.0 * s)
    bend = gap[i] * s * (1.0 - s) * ((1.0 - s) * slope[i] - s * slope[i + 1])
    return a + (b - a) * ease + bend


def _below(ground: Ground, position: Array, clearance: Array) -> Array:
    """How much higher (frames,) cameras must be for the hills under them to stay `clearance` below."""
    return np.maximum(ground.up(position[:, 0], position[:, 1]) + clearance - position[:, 2], 0.0)


def _hidden(ground: Ground, position: Array, target: Array, margin: float = 40.0) -> Array:
    """How much higher (frames,) cameras must be to see their target over the ridges between, by `margin`."""
    part = np.linspace(0.03, 0.85, 40)[:, None, None]  # of the way; near the target any slope hides it
    way = position + part * (target - position)
    ridge = ground.up(way[..., 0].ravel(), way[..., 1].ravel()).reshape(way.shape[:2])
    needed = (ridge + margin - way[..., 2]) / (1.0 - part[..., 0])
    return np.clip(needed.max(axis=0), 0.0, _HIGHEST)


def _eased(short: Array) -> Array:
    """Heights to add (frames,): at least `short`, changing smoothly over a sixth of the shot."""
    reach = max(len(short) // 12, 1)
    padded = np.pad(short, 2 * reach, "edge")
    highest = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1).max(1)
    window = np.hanning(2 * reach + 3)[1:-1]
    return np.convolve(highest, window / window.sum(), "valid")


def _aim(project: Project, run: Run, ground: Ground, key: CameraKey) -> Array:
    """Where a key points in every frame (frames, 3)."""
    if key.target == "point":
        place = ground.point(key.target_latitude, key.target_longitude, key.target_height)
        return np.repeat(place, project.time.frames, axis=0)
    times = clock.frame_times(project, run)
    follow = targets.head if key.target == "head" else targets.middle
    east, north = follow(ground, times)
    place = ground.point(*ground.geodetic(east, north), key.target_height)
    place[:, 2] = targets.smoothed(place[:, 2])
    return place


def _blend(at: Array, aims: Array, moments: Array) -> Array:
    """Between two keys the aim goes smoothly from that of one to that of the other."""
    if len(at) == 1:
        return aims[0]
    i = np.clip(np.searchsorted(at, moments, "right") - 1, 0, len(at) - 2)
    s = noise.smoothstep(0.0, 1.0, (moments - at[i]) / np.maximum(at[i + 1] - at[i], 1.0e-9))[:, None]
    frames = np.arange(len(moments))
    return aims[i, frames] * (1.0 - s) + aims[i + 1, frames] * s


def _look(position: Array, target: Array) -> Array:
    """Rotations (n, 3, 3) that look from `position` at `target` with the horizon level."""
    back = position - target
    back /= np.maximum(np.linalg.norm(back, axis=1, keepdims=True), 1.0e-9)
    right = np.cross([0.0, 0.0, 1.0], back)
    length = np.linalg.norm(right, axis=1, keepdims=True)
    right = np.where(length > 1.0e-6, right / np.maximum(length, 1.0e-9), [1.0, 0.0, 0.0])
    return np.stack([right, np.cross(back, right), back], axis=-1)
