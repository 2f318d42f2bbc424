"""Visibility of a shot: what its cameras see in the frames that they film, and how near they come."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from firetwin_core import lod
from numpy.typing import ArrayLike, NDArray

from . import sun
from .cameras.path import Path
from .terrain import mesh_tolerance
from .terrain.terrain import Ground

if TYPE_CHECKING:
    from .settings.protocols import ShotView


_HALF_SPACE = 1.0e9  # tangent of half of 180 degrees
_ONE_PLACE = 0.5  # m; to eyes farther apart the ground counts as hiding nothing: one may see past its edge


class Visibility:
    """Frustum and occlusion culling by the cameras of a shot; each view set is made when it is first needed.

    Attributes
    ----------
    unculled
        Nothing is culled: all counts as visible, and from as near as can be.
    """

    def __init__(self, shot: ShotView) -> None:
        self.shot, self.unculled = shot, not shot.settings.render.cull
        self._known: dict[tuple[int, ...], lod.ViewSet] = {}
        self._ground: lod.Occluder | None = None
        self._floor = 0.0

    def visible_mask(
        self,
        position: ArrayLike,
        radius: ArrayLike,
        *,
        reach: float = np.inf,
        margin: float = 0.0,
        shadows: bool = False,
        pixel: float = 0.0,
        perspective: bool = True,
    ) -> NDArray[np.bool_]:
        """Which balls (n,) any camera sees; nothing that is visible is left out.

        Parameters
        ----------
        position, radius
            (n, 3) m in the scene; (n,), or what broadcasts to it, m.
        reach
            How far from cameras in perspective, m.
        margin
            How much wider each view is, m: for what is no part of the picture, but of its light.
        shadows
            Whether what throws its shadow on a place that is seen counts as seen.
        pixel
            Cameras with parallel lines of sight count if their pixels are smaller than this, m.
        perspective
            Whether cameras in perspective count.
        """
        showing = self._showing(pixel, perspective)
        if self.unculled:
            flat = any(not self.shot.paths[number].perspective for number in showing)
            near = perspective and self.distance(position) - radius <= reach
            return np.broadcast_to(near | flat, len(np.asarray(position)))
        views = self._of(showing)
        return lod.visible_mask(position, radius, views, max_distance=reach, margin=margin, shadows=shadows)

    def distance(self, position: ArrayLike) -> NDArray[np.float64]:
        """Least distance (n,) of places (n, 3) from cameras in perspective, m; infinite without any."""
        return lod.distance(position, self._of(self._showing(0.0)))

    def lod_distance(self, position: ArrayLike) -> NDArray[np.float64]:
        """Distance (n,) that things at places (n, 3) are drawn for, m: 0 where nothing is skipped."""
        return np.zeros(len(position)) if self.unculled else self.distance(position)

    def distance_from(self, path: Path, position: ArrayLike) -> NDArray[np.float64]:
        """Least distance (n,) of places (n, 3) from one camera in perspective, m."""
        return lod.distance(position, self._made([path]))

    def view_set(self, frame: int) -> lod.ViewSet | None:
        """What all cameras that film this frame see in it; None where none does, or nothing is skipped."""
        if self.unculled:
            return None
        paths = self._filming(frame)
        return self._made(paths, frame - 1) if paths else None

    def eyes(self, frame: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Where a frame is seen from: places (n, 3), m, and unit vectors (m, 3) to cameras of parallel lines.

        Both are empty where no camera films it, or nothing is skipped.
        """
        paths = [] if self.unculled else self._filming(frame)
        places = [path.position[frame - 1] for path in paths if path.perspective]
        back = [path.rotation[frame - 1, :, 2] for path in paths if not path.perspective]
        return np.reshape(places, (-1, 3)), np.reshape(back, (-1, 3))

    def _filming(self, frame: int) -> list[Path]:
        return [path for path in self.shot.paths if frame - 1 in self.shot.filmed(path)]

    def _showing(self, pixel: float, perspective: bool = True) -> tuple[int, ...]:
        """Numbers of the cameras in perspective, if they count, and of others of small enough pixels."""
        return tuple(
            number
            for number, path in enumerate(self.shot.paths)
            if (perspective if path.perspective else path.pixel < pixel)
        )

    def _of(self, numbers: tuple[int, ...]) -> lod.ViewSet:
        if numbers not in self._known:
            self._known[numbers] = self._made([self.shot.paths[number] for number in numbers])
        return self._known[numbers]

    def _made(self, paths: list[Path], frame: int | None = None) -> lod.ViewSet:
        """What these cameras see in all that they film, or in a frame (from 0)."""
        shot = self.shot
        filmed = [shot.filmed(path) if frame is None else np.array([frame]) for path in paths]
        looks = [
            (path, frames, *look)
            for path, frames in zip(paths, filmed, strict=True)
            for look in _looks(path, frames)
        ]
        counts = [len(frames) for _, frames, _, _ in looks]
        position = _joined([path.position[frames] for path, frames, _, _ in looks], (3,))
        one = np.repeat([path.apart <= _ONE_PLACE for path, *_ in looks], counts).astype(bool)
        if self._ground is None:
            self._ground, self._floor = _occluder(shot)
        return lod.ViewSet(
            position,
            _joined([rotation for _, _, rotation, _ in looks], (3, 3)),
            _joined([halves for _, _, _, halves in looks], (2,)),
            sun=self._sun(_joined([frames for _, frames, _, _ in looks], ()).astype(np.int64)),
            orthographic=np.repeat([not path.perspective for path, *_ in looks], counts).astype(bool),
            above_terrain=_clear(shot.ground, position) & one,
            occluder=self._ground,
            lowest_terrain=self._floor,
        )

    def _sun(self, frames: NDArray[np.int64]) -> NDArray[np.float64]:
        """Where light comes from in frames (m,) from 0: unit vectors (m, 3)."""
        each, number = np.unique(frames, return_inverse=True)
        times = self.shot.frames.times[each]
        return np.array([sun.toward_light(self.shot.run, float(t)) for t in times]).reshape(-1, 3)[number]


def _looks(path: Path, frames: NDArray[np.int64]) -> list[tuple[NDArray, NDArray]]:
    """Rotations (n, 3, 3) and `half` (n, 2) of what a camera sees; all round is before it and behind."""
    rotation = path.rotation[frames]
    if not path.around:
        return [(rotation, path.halves[frames])]
    half = np.full((len(frames), 2), _HALF_SPACE)
    return [(rotation, half), (rotation @ np.diag([-1.0, 1.0, -1.0]), half)]


def _joined(parts: list[NDArray], shape: tuple[int, ...]) -> NDArray:
    return np.concatenate(parts) if parts else np.empty((0, *shape))


def _occluder(shot: ShotView) -> tuple[lod.Occluder, float]:
    """The run's part of the ground, as what hides, and the lowest scene z of all of it.

    It is as much lower as its mesh may be where it is seen, for where a line of sight goes into the ground it
    is seen. Hills of the apron hide nothing: its cells are too large to make good walls.
    """
    floor, margin = shot.ground.floor(), shot.ground.fields.margin
    lowest = float(floor[..., 2].min()) - mesh_tolerance.UNSEEN
    inner = slice(margin, -margin or None)
    floor = floor[inner, inner]
    floor[..., 2] -= mesh_tolerance.most(shot, _distance(shot, floor))
    return lod.Occluder(floor), lowest


def _distance(shot: ShotView, place: NDArray[np.float64]) -> NDArray[np.float64]:
    """Least distance of places (ny, nx, 3) from cameras in perspective, m."""
    views = [(path, shot.filmed(path)) for path in shot.perspective_paths]
    position = _joined([path.position[frames] for path, frames in views], (3,))
    rotation = _joined([path.rotation[frames] for path, frames in views], (3, 3))
    alone = lod.ViewSet(position, rotation, np.ones(2))
    return lod.distance(place.reshape(-1, 3), alone).reshape(place.shape[:2])


def _clear(ground: Ground, position: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which places are surely above the ground as it is drawn, which is `rough`."""
    if len(position) == 0:
        return np.empty(0, bool)
    return position[:, 2] > ground.up(position[:, 0], position[:, 1]) + ground.rough
