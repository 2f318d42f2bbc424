"""Visibility culling: frustum culling, occlusion culling and camera distance over a shot's filmed frames."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from firetwin_core import lod
from firetwin_core.run import Run
from numpy.typing import ArrayLike, NDArray

from ...run import sun
from ..terrain.terrain import Terrain
from .mesh_error import UNSEEN, ErrorBounds
from .path import Path

_HALF_SPACE = 1.0e9  # tangent of 90 degrees, half the angle of a hemisphere
_ONE_POINT = 0.5  # m; with eyes farther apart terrain does not occlude: one eye may see past its edge


class Visibility:
    """Frustum and occlusion culling by the cameras of a shot. View sets are built at first use and cached.

    Parameters
    ----------
    filmed
        Frames, from 0, that the camera of a path films.
    heights
        Picture height of each path, pixels.
    times
        Model times of all frames, s.
    bounds
        Error bounds of the drawn terrain.

    Attributes
    ----------
    unculled
        Culling is off: everything counts as visible, at distance 0.
    """

    def __init__(
        self,
        paths: list[Path],
        filmed: Callable[[Path], NDArray[np.int64]],
        heights: list[int],
        ground: Terrain,
        run: Run,
        times: NDArray[np.float64],
        bounds: ErrorBounds,
        cull: bool,
    ) -> None:
        self.paths, self.filmed, self.heights = paths, filmed, heights
        self.ground, self.run, self.times, self.bounds, self.unculled = ground, run, times, bounds, not cull
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
        """Visible mask (n,) of bounding spheres. Conservative: no visible sphere is culled.

        Parameters
        ----------
        position, radius
            Sphere centres (n, 3) in the scene, m, and radii (n,) or broadcastable, m.
        reach
            Maximum distance from perspective cameras, m.
        margin
            Width added to each view frustum, m, for objects outside of the picture that light it.
        shadows
            Count an object as visible if its shadow falls on a visible place.
        pixel
            Orthographic cameras count if their pixels are smaller than this, m.
        perspective
            Count perspective cameras.
        """
        showing = self._counted_cameras(pixel, perspective)
        if self.unculled:
            flat = any(not self.paths[number].perspective for number in showing)
            near = perspective and self.distance(position) - np.asarray(radius) <= reach
            return np.broadcast_to(near | flat, len(np.asarray(position)))
        views = self._views_of(showing)
        return lod.visible_mask(position, radius, views, max_distance=reach, margin=margin, shadows=shadows)

    def distance(self, position: ArrayLike) -> NDArray[np.float64]:
        """Distance (n,) from points (n, 3) to the nearest perspective camera, m; infinite without one."""
        return lod.distance(position, self._views_of(self._counted_cameras(0.0)))

    def lod_distance(self, position: ArrayLike) -> NDArray[np.float64]:
        """Distance (n,) that sets the level of detail of objects at points (n, 3), m; 0 with culling off."""
        return np.zeros(len(np.asarray(position))) if self.unculled else self.distance(position)

    def distance_from(self, path: Path, position: ArrayLike) -> NDArray[np.float64]:
        """Smallest distance (n,) from points (n, 3) to the path of one perspective camera, m."""
        return lod.distance(position, self._build([path]))

    def view_set(self, frame: int) -> lod.ViewSet | None:
        """View set of all cameras that film a frame; None without such a camera or with culling off."""
        if self.unculled:
            return None
        paths = self._filming(frame)
        return self._build(paths, frame - 1) if paths else None

    def eyes(self, frame: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Viewpoints of a frame: eye points (n, 3), m, and unit vectors (m, 3) to orthographic cameras.

        Both are empty if no camera films the frame or culling is off.
        """
        paths = [] if self.unculled else self._filming(frame)
        places = [path.position[frame - 1] for path in paths if path.perspective]
        back = [path.rotation[frame - 1, :, 2] for path in paths if not path.perspective]
        return np.reshape(places, (-1, 3)), np.reshape(back, (-1, 3))

    def all_views(self) -> tuple[lod.ViewSet, NDArray, NDArray, NDArray]:
        """Collect the views of all cameras in all frames that they film.

        Returns
        -------
        The view set of m views; (m,) heights of their pictures, pixels; (m,) half heights, as tangents or m;
        and (k, 3) eyes of perspective cameras, m.
        """
        paths = self.paths
        looks = [(path, half) for path in paths for _, half in _frusta(path, self.filmed(path))]
        rows = [
            np.full(len(half), float(height))
            for path, height in zip(paths, self.heights, strict=True)
            for _, half in _frusta(path, self.filmed(path))
        ]
        eyes = [path.position[self.filmed(path)] for path in paths if path.perspective]
        halves = _joined([half[:, 1] for _, half in looks], ())
        return self._views_of(tuple(range(len(paths)))), _joined(rows, ()), halves, _joined(eyes, (3,))

    def _filming(self, frame: int) -> list[Path]:
        return [path for path in self.paths if frame - 1 in self.filmed(path)]

    def _counted_cameras(self, pixel: float, perspective: bool = True) -> tuple[int, ...]:
        """Return indices of cameras that count: perspective ones if wanted, orthographic by pixel size."""
        return tuple(
            number
            for number, path in enumerate(self.paths)
            if (perspective if path.perspective else path.pixel < pixel)
        )

    def _views_of(self, numbers: tuple[int, ...]) -> lod.ViewSet:
        if numbers not in self._known:
            self._known[numbers] = self._build([self.paths[number] for number in numbers])
        return self._known[numbers]

    def _build(self, paths: list[Path], frame: int | None = None) -> lod.ViewSet:
        """View set of some cameras, over all frames that they film or in one frame (from 0)."""
        filmed = [self.filmed(path) if frame is None else np.array([frame]) for path in paths]
        looks = [
            (path, frames, *look)
            for path, frames in zip(paths, filmed, strict=True)
            for look in _frusta(path, frames)
        ]
        counts = [len(frames) for _, frames, _, _ in looks]
        position = _joined([path.position[frames] for path, frames, _, _ in looks], (3,))
        one = np.repeat([path.apart <= _ONE_POINT for path, *_ in looks], counts).astype(bool)
        if self._ground is None:
            self._ground, self._floor = self._occluder()
        return lod.ViewSet(
            position,
            _joined([rotation for _, _, rotation, _ in looks], (3, 3)),
            _joined([halves for _, _, _, halves in looks], (2,)),
            sun=self._sun(_joined([frames for _, frames, _, _ in looks], ()).astype(np.int64)),
            orthographic=np.repeat([not path.perspective for path, *_ in looks], counts).astype(bool),
            above_terrain=_clear(self.ground, position) & one,
            occluder=self._ground,
            lowest_terrain=self._floor,
        )

    def _sun(self, frames: NDArray[np.int64]) -> NDArray[np.float64]:
        """Compute unit vectors (m, 3) towards the sun or moon in frames (m,), from 0."""
        each, number = np.unique(frames, return_inverse=True)
        times = self.times[each]
        return np.array([sun.toward_light(self.run, float(t)) for t in times]).reshape(-1, 3)[number]

    def _occluder(self) -> tuple[lod.Occluder, float]:
        """Terrain occluder of the run's area, and the lowest scene z of all terrain.

        The occluder lies below the terrain by the mesh tolerance: a ray that enters the drawn ground still
        counts as unobstructed. Apron hills do not occlude, as their cells are too coarse.
        """
        floor, margin = self.ground.floor(), self.ground.fields.margin
        lowest = float(floor[..., 2].min()) - UNSEEN
        inner = slice(margin, -margin or None)
        floor = floor[inner, inner]
        floor[..., 2] -= self.bounds.at(self._eye_distance(floor))
        return lod.Occluder(floor), lowest

    def _eye_distance(self, place: NDArray[np.float64]) -> NDArray[np.float64]:
        """Smallest distance (ny, nx) from points (ny, nx, 3) to perspective cameras, m."""
        views = [(path, self.filmed(path)) for path in self.paths if path.perspective]
        position = _joined([path.position[frames] for path, frames in views], (3,))
        rotation = _joined([path.rotation[frames] for path, frames in views], (3, 3))
        alone = lod.ViewSet(position, rotation, np.ones(2))
        return lod.distance(place.reshape(-1, 3), alone).reshape(place.shape[:2])


def _frusta(path: Path, frames: NDArray[np.int64]) -> list[tuple[NDArray, NDArray]]:
    """View frusta of a camera: rotations (n, 3, 3) and `half` (n, 2). A panorama has two: ahead, behind."""
    rotation = path.rotation[frames]
    if not path.around:
        return [(rotation, path.halves[frames])]
    half = np.full((len(frames), 2), _HALF_SPACE)
    return [(rotation, half), (rotation @ np.diag([-1.0, 1.0, -1.0]), half)]


def _joined(parts: list[NDArray], shape: tuple[int, ...]) -> NDArray:
    return np.concatenate(parts) if parts else np.empty((0, *shape))


def _clear(ground: Terrain, position: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Return whether points are certainly above the drawn terrain, by more than its roughness `rough`."""
    if len(position) == 0:
        return np.empty(0, bool)
    return position[:, 2] > ground.up(position[:, 0], position[:, 1]) + ground.rough
