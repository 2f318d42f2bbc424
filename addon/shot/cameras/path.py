"""Camera paths: position, rotation and lens of a camera in every frame. Needs no Blender."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..terrain import noise
from ..terrain.terrain import Terrain

if TYPE_CHECKING:
    from firetwin_core import geo

    from ..sections.camera import CameraSettings

SENSOR = 36.0  # mm, sensor width of a full-frame camera
UP = np.array([0.0, 0.0, 1.0])
_NEAREST = 0.5  # m
_HIGHEST_AIR = 20_000.0  # m, above any smoke
_HIGHEST = 1500.0  # m, limit to which a camera is raised to see over a ridge
_FFT_REACH = 500  # values, half a window from which the mean is taken by FFT
_RIDGE_SAMPLES = 600  # frames at most that are tested for ridges

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Path:
    """Path of a camera through the shot.

    Attributes
    ----------
    position
        (frames, 3) metres in the scene.
    rotation
        (frames, 3, 3) rotation matrices; their columns are the camera's right, up and back.
    target
        (frames, 3) look-at points.
    half
        Tangents of half the horizontal and vertical angle of view. In an orthographic view, half the width
        and height of the picture, m. A zoom lens has the values at its longest focal length.
    perspective
        True for a perspective projection, False for an orthographic one.
    hidden
        (frames,) height to add to the keys so that the target is visible over ridges, m; None: not computed.
    sensor
        Sensor width, mm.
    wider
        (frames,) factor on `half` in each frame, for zoom; None: 1 in all frames.
    meet
        Distance (m) from the target to the eye of a very distant camera that counts as orthographic; `half`
        is its picture at the target. 0: parallel rays.
    around
        True for a panorama of all directions. `half` is then half of its angles, radians.
    apart
        Eye separation, m. The eyes are right and left of `position` in each direction of view.
    clips
        (frames, 2) near and far clip planes, m; None: `clip` in all frames.
    beyond
        True if it sees the Earth beyond the terrain, which is built then.
    width
        Picture width (of one eye), pixels; the shot fills it in.
    """

    camera: CameraSettings
    position: Array
    rotation: Array
    target: Array
    half: tuple[float, float]
    perspective: bool = True
    hidden: Array | None = None
    sensor: float = SENSOR
    wider: Array | None = None
    meet: float = 0.0
    around: bool = False
    apart: float = 0.0
    clips: Array | None = None
    beyond: bool = False
    width: int = 0

    @property
    def pixel(self) -> float:
        """Smallest pixel size: m per m of distance in perspective, and m in an orthographic view."""
        return 2.0 * self.half[0] / self.width

    @property
    def halves(self) -> Array:
        """`half` in every frame (frames, 2)."""
        wider = np.ones(len(self.position)) if self.wider is None else self.wider
        return wider[:, None] * np.array(self.half)


def finest(paths: list[Path]) -> tuple[float, float]:
    """Smallest pixel sizes of perspective and orthographic paths (see `Path.pixel`); infinite if none."""
    near, far = (
        min((path.pixel for path in paths if path.perspective == kind), default=np.inf)
        for kind in (True, False)
    )
    return near, far


def eyes(ways: list[Array], radius: float) -> Array:
    """Sample points (m, 3) of paths (n, 3), a quarter of `radius` apart, for terrain detail."""
    samples: list[Array] = []
    for way in ways:
        last = None
        for place in way:
            if last is None or np.linalg.norm(place - last) > 0.25 * radius:
                samples.append(place)
                last = place
    return np.array(samples).reshape(-1, 3)


def near_terrain(view: Path, position: Array, ground: Terrain, radius: float) -> Array:
    """Places (n, 3) of a camera that may be within `radius` (m) of terrain; all of a camera on Earth."""
    if not view.beyond:
        return position
    most = float(ground.fields.elevation.max()) + radius
    return position[ground.frame.reverse(position)[2] < most]


def smooth(at: Array, values: Array, moments: Array) -> Array:
    """Monotone cubic interpolation through (at, values), clamped outside (Fritsch and Butland 1984)."""
    if len(at) == 1:
        return np.full(len(moments), values[0])
    gap, delta = np.diff(at), np.diff(values)
    if np.any(gap <= 0.0):
        at, keep = np.unique(at, return_index=True)
        return smooth(at, values[keep], moments)
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
    bend = gap[i] * s * (1.0 - s) * ((1.0 - s) * slope[i] - s * slope[i + 1])
    return a + (b - a) * noise.smoothstep(0.0, 1.0, s) + bend


def hidden(ground: Terrain, position: Array, target: Array, margin: float = 40.0) -> Array:
    """Height deficit (frames,), m: how much cameras must rise to see their target over ridges.

    The line of sight clears ridges by `margin` m. A long film is tested in `_RIDGE_SAMPLES` frames, with
    linear interpolation between.
    """
    frames = np.arange(len(position))
    some = np.unique(np.linspace(0, len(frames) - 1, min(len(frames), _RIDGE_SAMPLES)).round().astype(int))
    part = np.linspace(0.03, 0.85, 40)[:, None, None]  # of the line; slopes near its end block it
    way = position[some] + part * (target - position)[some]
    ridge = ground.up(way[..., 0].ravel(), way[..., 1].ravel()).reshape(way.shape[:2])
    needed = (ridge + margin - way[..., 2]) / (1.0 - part[..., 0])
    return np.interp(frames, some, np.clip(needed.max(axis=0), 0.0, _HIGHEST))


def eased(short: Array) -> Array:
    """Smooth height offsets (frames,), at least `short`, that ease over a sixth of the shot."""
    reach = max(len(short) // 12, 1)
    return hann_mean(_moving_maximum(np.pad(short, 2 * reach, "edge"), 2 * reach + 1), reach)


def hann_mean(values: Array, reach: int) -> Array:
    """Return the moving average (n - 2 reach,) of values (n,) under a Hann window of 2 reach + 1 values."""
    window = np.hanning(2 * reach + 3)[1:-1]
    window /= window.sum()
    if reach < _FFT_REACH:
        return np.convolve(values, window, "valid")
    spectrum = np.fft.rfft(values) * np.fft.rfft(window, len(values))
    return np.fft.irfft(spectrum, len(values))[2 * reach :]  # the first values wrap around


def _moving_maximum(values: Array, width: int) -> Array:
    """Return the maximum (n - width + 1,) of every `width` neighbours of values (n,)."""
    span = 1
    while 2 * span <= width:
        values = np.maximum(values[:-span], values[span:])
        span *= 2
    rest = width - span
    return np.maximum(values[: len(values) - rest], values[rest:])


def blend(at: Array, aims: Array, moments: Array) -> Array:
    """Interpolate look-at points (aims) smoothly between keys."""
    if len(at) == 1:
        return aims[0]
    i = np.clip(np.searchsorted(at, moments, "right") - 1, 0, len(at) - 2)
    s = noise.smoothstep(0.0, 1.0, (moments - at[i]) / np.maximum(at[i + 1] - at[i], 1.0e-9))[:, None]
    frames = np.arange(len(moments))
    return aims[i, frames] * (1.0 - s) + aims[i + 1, frames] * s


def look(position: Array, target: Array, up: Array = UP) -> Array:
    """Look-at rotations (n, 3, 3) from `position` to `target`; the horizon is level across `up` (3,)."""
    back = position - target
    back /= np.maximum(np.linalg.norm(back, axis=1, keepdims=True), 1.0e-9)
    right = np.cross(up, back)
    length = np.linalg.norm(right, axis=1, keepdims=True)
    right = np.where(length > 1.0e-6, right / np.maximum(length, 1.0e-9), [1.0, 0.0, 0.0])
    return np.stack([right, np.cross(back, right), back], axis=-1)


def compass(frame: geo.LocalFrame, place: Array) -> tuple[Array, Array, Array]:
    """Local east, north and up unit vectors (3,) at a scene point (3,), by the ellipsoid's normal."""
    latitude, longitude, height = (float(v[0]) for v in frame.reverse(place[None]))
    north = frame.forward([latitude - 1.0e-3, latitude + 1.0e-3], [longitude] * 2, [height] * 2)
    up = frame.forward([latitude] * 2, [longitude] * 2, [height - 1000.0, height + 1000.0])
    north, up = ((ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0]) for ends in (north, up))
    return np.cross(north, up), north, up


def clip(view: Path, ground: Terrain) -> tuple[float, float]:
    """Near and far clip distances of a camera, m, that contain the terrain and the air above it.

    A camera above all content has its near plane half-way to it, which keeps depth precision.
    """
    latitude, longitude = (np.linspace(axis[0], axis[-1], 17) for axis in _axes(ground))
    heights = [float(ground.fields.elevation.min()), _HIGHEST_AIR]
    points = np.concatenate(
        [ground.frame.forward_grid(latitude, longitude, np.full((17, 17), h)).reshape(-1, 3) for h in heights]
    )
    middle = view.position.mean(axis=0)
    spread = float(np.linalg.norm(view.position - middle, axis=1).max())
    away = np.linalg.norm(points - middle, axis=1)
    above = view.position[:, 2].min() > points[:, 2].max()
    near = 0.5 * (float(away.min()) - spread) if above else 0.0
    return max(near, _NEAREST), 1.05 * (float(away.max()) + spread)


def _axes(ground: Terrain) -> tuple[Array, Array]:
    return ground.fields.latitude, ground.fields.longitude
