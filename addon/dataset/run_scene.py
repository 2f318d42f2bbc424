"""Run of a plan as a place for cameras: ground, front and wind at any model time. Needs no Blender."""

from __future__ import annotations

import functools
from dataclasses import replace
from functools import cached_property

import numpy as np
from firetwin_core import lod
from firetwin_core.run import Run
from numpy.typing import NDArray

from ..auto_framing.coarse_smoke import CoarseSmoke
from ..auto_framing.front import front_at, some
from ..run import burning, readers, times
from ..shot.sections import Time
from ..shot.settings import Settings, scene_file
from ..shot.shot import Shot
from ..shot.terrain.terrain import NEVER
from .plan import PlanRun

_POINTS = 160  # front points at most per time
_RADIUS = 1.0  # m, radius of a front point
_CANOPY = 0.01  # kg/m2, canopy fuel from which there are trees
TREE = 35.0
"""Height above ground at which a camera is clear of trees, m (assumed)."""
_OPEN = 5.0  # m, the same without trees (assumed)
_CROWNS = 25.0  # m above ground, height of crowns that hide the land behind them (assumed)
_CELLS = 0.4  # million flow cells per second of model time, as in `places`
_RAYS = 7, 5  # across and up a picture, in which smoke and crowns are measured
_STEPS = 12  # along such a ray

Array = NDArray[np.float64]


def settings_of(run: PlanRun) -> Settings:
    """Read the scene file of a run, or make default settings for a run folder, with the cache next to it.

    Raises
    ------
    InputError
        The scene file cannot be read.
    """
    if run.run.suffix == ".toml":
        return scene_file.read(run.run)
    folder = run.run.parent
    return Settings(path=folder / f"{run.name}.toml", run=run.run, cache=folder / "cache")


class RunScene:
    """Ground, front and wind of a run.

    Attributes
    ----------
    settings
        Settings of the run's scene file.
    run, shot
        The run, and a shot of it with the times and cameras of the scene file.
    ground
        Terrain without detail near cameras.
    """

    def __init__(self, planned: PlanRun) -> None:
        self.settings = settings_of(planned)
        self.run: Run = readers.open(self.settings.run)
        self.shot = Shot(self.settings, self.run)
        self._arrival, self.ground = self.shot.arrival, self.shot.bare_ground

    @cached_property
    def ignition(self) -> float:
        """Time of the first fire, s; it can precede the run's first time. NaN without fire."""
        return float(np.nanmin(self._arrival)) if np.isfinite(self._arrival).any() else np.nan

    @cached_property
    def window(self) -> tuple[float, float]:
        """First and last model time of the run at which fire can burn, s."""
        first, last = float(self.run.times[0]), float(self.run.times[-1])
        return min(max(self.ignition, first), last), last

    @functools.lru_cache(maxsize=64)  # noqa: B019 (as long as the scene)
    def front(self, time: float) -> Array:
        """Front points (n, 3) at a model time, or nearest to it, m in the run's local frame; 160 at most."""
        points = front_at(self.ground, time)[0]
        return points[some(np.arange(len(points)), _POINTS)]

    @functools.lru_cache(maxsize=64)  # noqa: B019
    def upwind(self, time: float) -> float:
        """Bearing from which the wind near the fire blows, degrees; 0 without wind."""
        east, north = burning.wind_at(self.run, np.array([time]), self._surroundings)[0]
        return float(np.degrees(np.arctan2(-east, -north))) % 360.0

    @cached_property
    def _surroundings(self) -> tuple[slice, slice]:
        return burning.surroundings(self.run, self._arrival)

    @functools.lru_cache(maxsize=64)  # noqa: B019
    def smoke(self, time: float) -> CoarseSmoke:
        """Solve the smoke of a coarse flow at a model time; this takes about a second."""
        settings = self.settings
        still = Time(start=times.utc(self.run, time), frames=1, shutter=0.0, zone=settings.time.zone)
        smoke = replace(settings.smoke, cell_budget=_CELLS)
        shot = Shot(replace(settings, time=still, smoke=smoke, cameras=(), runs=()), self.run)
        shot.relief, shot.arrival = self.shot.relief, self._arrival
        shot.bare_ground = self.ground
        return CoarseSmoke(shot, [0])

    def veil(
        self, time: float, position: Array, rotation: Array, half: tuple[float, float], reach: float
    ) -> float:
        """Compute the mean opacity of smoke in a picture, up to a distance of `reach` m, 0..1."""
        rays = self._rays(rotation, half)
        depth = self.smoke(time).depth(0, position, position + reach * rays)
        return float(np.mean(1.0 - np.exp(-depth)))

    @cached_property
    def burned(self) -> Array:
        """Points (n, 3) of the ground that burns in the run, m; 160 at most."""
        row, column = np.nonzero((self.ground.arrival < NEVER) & (self.ground.burned >= 0.5))  # no islands
        chosen = some(np.arange(len(row)), _POINTS)
        return self.ground.point(*self.ground.places(row[chosen], column[chosen]))

    def has_ground(self, position: Array) -> bool:
        """Return whether the terrain, with its apron, extends below a point (3,)."""
        latitude, longitude, _ = (float(part[0]) for part in self.ground.frame.reverse(position[None]))
        fields = self.ground.fields
        inside = fields.latitude[0] < latitude < fields.latitude[-1]
        return bool(inside and fields.longitude[0] < longitude < fields.longitude[-1])

    def height_above_ground(self, position: Array) -> float:
        """Height of a point (3,) above the ground, m."""
        return float(position[2] - self.ground.up(position[0], position[1])[0])

    def trees(self, east: Array, north: Array) -> NDArray[np.bool_]:
        """Return whether trees grow at points (n,), m."""
        return self.ground.sample(self.ground.fields.canopy_fuel, east, north) > _CANOPY

    def clearance(self, position: Array) -> float:
        """Least height of a mobile camera above the ground below a point (3,), m."""
        return TREE if self.trees(position[:1], position[1:2])[0] else _OPEN

    def in_crowns(self, points: Array) -> NDArray[np.bool_]:
        """Return whether points (..., 3) are lower than the crowns of the trees there (...), m."""
        x, y, z = points.reshape(-1, 3).T
        low = (z < self.ground.up(x, y) + _CROWNS) & self.trees(x, y)
        return low.reshape(points.shape[:-1])

    def crowded(self, position: Array, rotation: Array, half: tuple[float, float], reach: float) -> float:
        """Compute the share of a picture that crowns closer than `reach` m fill, 0..1."""
        rays = self._rays(rotation, half)
        steps = reach * (np.arange(_STEPS) + 1.0) / _STEPS
        return float(np.mean(self.in_crowns(position + steps[:, None, None] * rays).any(axis=0)))

    @staticmethod
    def _rays(rotation: Array, half: tuple[float, float]) -> Array:
        """Return directions (n, 3) spread over a picture."""
        x, y = (part.ravel() for part in np.meshgrid(*(np.linspace(-0.9, 0.9, count) for count in _RAYS)))
        rays = np.stack([x * half[0], y * half[1], -np.ones_like(x)], axis=-1)
        return rays / np.linalg.norm(rays, axis=-1, keepdims=True) @ rotation.T

    def visible(
        self, points: Array, position: Array, rotation: Array, half: tuple[float, float]
    ) -> NDArray[np.bool_]:
        """Return which points (n, 3) are in the picture and not hidden by terrain (n,).

        Parameters
        ----------
        position, rotation
            (3,) m and (3, 3) of the camera, which is above the ground.
        half
            Tangents of half the horizontal and vertical angle of view.
        """
        view = lod.ViewSet(
            position[None], rotation[None], np.array([half]), above_terrain=True, occluder=self._occluder
        )
        return lod.visible_mask(points, np.full(len(points), _RADIUS), view)

    @cached_property
    def _occluder(self) -> lod.Occluder:
        margin = self.ground.fields.margin
        return lod.Occluder(self.ground.floor()[margin : -margin or None, margin : -margin or None])
