"""Shot: a scene file resolved with its fire model run, as input of building, baking and rendering."""

from __future__ import annotations

import copy
import functools
from collections.abc import Callable, Collection
from dataclasses import replace
from datetime import datetime
from functools import cached_property
from pathlib import Path as FolderPath
from typing import Any, TypeVar

import numpy as np
from firetwin_core import geo
from firetwin_core.run import Run
from numpy.typing import NDArray

from .. import timecode
from ..errors import UsageError
from ..progress import Progress, duration, silent
from ..run import burning, content, run_warnings, times, zone
from ..run.frame import local_frame
from . import frames
from .cameras import camera_warnings, path
from .cameras.mesh_error import error_bounds
from .cameras.path import SENSOR, Path
from .cameras.rigs import Filming
from .cameras.visibility import Visibility
from .fire import air_temperature, flame_depth, flame_state, smoke_scale
from .fire.fire import Fire
from .fire.fuel import DETAIL
from .fire.smoke_scale import Scale
from .frames import Frames
from .runs import scene_runs
from .schema.frame_list import FrameList
from .sections.camera import CameraSettings
from .settings import Camera, Settings, tile_heights_file
from .terrain import elevation
from .terrain.elevation import Elevation
from .terrain.terrain import Terrain

_BURNING_BEFORE = 3600.0  # s before the first frame; ground that burned in this time still counts as burning
WIDE_LENS = 28.0  # mm, reference focal length at which orthographic views are compared with perspective ones
_SPIN_UP = 1800.0  # s, spin-up of a fire 15 km across
_OF_FIRE = "front", "flame_length"  # cached properties that do not depend on times and cameras
_NO_FIRE_DISTANCE = 20_000.0  # m, fire distance of a shot without cameras or without fire


Value = TypeVar("Value")


def cached_on_shot(compute: Callable[[Shot], Value]) -> Callable[[Shot], Value]:
    """Decorate a function of a shot alone: it is called once for each shot, which caches the result."""

    @functools.wraps(compute)
    def cached(shot: Shot) -> Value:
        if compute not in shot.cached:
            shot.cached[compute] = compute(shot)
        return shot.cached[compute]

    return cached


_FILM: dict[str, tuple[Any, Any]] = {}
"""Values for the film of a growing run in this process, by name, each with its inputs."""


def cached_in_film(name: str, shot: Shot, compute: Callable[[], Value], *inputs: Any) -> Value:
    """Return a value that does not depend on the run's times, except through `inputs`.

    A process that films a growing run computes it once for all known runs (see `run.content.IDENTITY`).
    """
    film = content.identity(FolderPath(shot.run.path))
    if not film:
        return compute()
    settings = replace(shot.settings, run=FolderPath(), cache=FolderPath())
    wanted = film, settings, *inputs
    if name not in _FILM or _FILM[name][0] != wanted:
        _FILM[name] = wanted, compute()
    return _FILM[name][1]


class Shot:
    """A scene file resolved with its run.

    Expensive properties are computed at first use and cached.

    Attributes
    ----------
    settings
        The scene file. A missing time zone is filled in from the run, and `time.speed` is replaced by the
        start or end that it determines, a missing `time.shutter` by its default.
    run
        The model run.
    frames
        Frames and their model times.
    relief
        Terrain elevation on the run's grids.
    cameras
        All cameras of the scene file. A filmed camera may follow one that is not filmed.
    full
        The full shot of which this is a subset; else itself.
    cached
        Results of `cached_on_shot`, by function.
    """

    def __init__(self, settings: Settings, run: Run) -> None:
        time = settings.time.resolved()
        settings = replace(settings, time=replace(time, zone=time.zone or zone.time_zone(run)))
        self.settings, self.run, self.cameras, self.full = settings, run, settings.cameras, self
        self.frames: Frames = frames.resolve(settings.time, run)
        if settings.time.shutter is None:
            quick, long = frames.TIME_LAPSE
            time = replace(settings.time, shutter=long if self.speed > quick else 0.0)
            self.settings = replace(settings, time=time)
        self.cached: dict[Callable[[Shot], Any], Any] = {}
        self._filmed: dict[str, NDArray[np.int64]] = {}
        on_tiles = settings.terrain.height_source == "tiles"
        tiles = tile_heights_file.location(settings, run) if on_tiles else None
        self.relief: Elevation = elevation.resolve(settings, run, tiles)

    def input_hashes(self, leave_out: Collection[str] = (), progress: Progress = silent) -> dict[str, str]:
        """SHA-256 of each input: the run's fields except `leave_out`, elevation model, tilesets of files."""
        settings = self.settings
        hashes = content.inputs(self.run, settings.cache, leave_out, progress)
        model = settings.terrain.elevation
        if model:
            hashes["elevation model"] = content.of_file(model, settings.cache, progress)
        for place in settings.tiles.sources:
            path = settings.path.parent / place
            path = path / "tileset.json" if path.is_dir() else path
            if path.is_file():
                hashes[f"tiles {place}"] = content.of_file(path, settings.cache, progress)
        return hashes

    @cached_property
    def arrival(self) -> NDArray[np.float64]:
        """Fire arrival time (fy, fx), s, at the centre of each fuel cell; NaN where it never burns."""
        return self.run.fuel_arrival_time()

    @property
    def speed(self) -> float:
        """Speed of the films, times real time; 0 for a still."""
        return self.frames.step * float(self.settings.time.rate)

    def with_sub_frames(self, parts: int) -> Shot:
        """Return the shot with each frame interval divided into `parts`, for the flow of its smoke alone."""
        if parts == 1:
            return self
        _ = self.scale, self.fire, self.bare_ground, self.paths  # computed once for both
        finer, shown = copy.copy(self), self.frames
        finer.frames = Frames(shown.first, shown.last, (shown.count - 1) * parts + 1)
        time = replace(self.settings.time, frames=finer.frames.count)
        finer.settings, finer.cached = replace(self.settings, time=time), {}
        return finer

    def describe_film(self) -> str:
        """Describe a film: ``5 frames at 12 frames per second show 5 s of the fire, 15 times real time``."""
        shown, rate = self.frames, self.settings.time.rate
        if shown.count == 1:
            return "1 frame, a still"
        film = f"{shown.count} frames at {timecode.format_rate(rate)} frame{'s' * (rate != 1)} per second"
        speed = float(f"{self.speed:.3g}")
        return f"{film} show {duration(shown.last - shown.first)} of the fire, {speed:,g} times real time"

    @cached_property
    def scale(self) -> Scale:
        """Resolution scale of the flow solver and of its smoke."""
        long = smoke_scale.extent(self.run, self.arrival, self.frames.first, self.frames.last)
        return smoke_scale.choose(long, max(burning.fuel_cell(self.run)), self.settings.smoke.cell_budget)

    @property
    def spin_up(self) -> float:
        """Time that the smoke flow is solved before the first frame, s; its default scales with the fire."""
        value = self.settings.smoke.spin_up
        return self.scale.time(_SPIN_UP) if value is None else value

    @cached_property
    def fire(self) -> Fire:
        """The fire from the first frame to the last, with the history that smoke needs."""
        before = max(self.spin_up + burning.BURN_TIME, _BURNING_BEFORE)
        span = self.frames.first, self.frames.last, before
        return Fire(self.run, *span, self.relief, self.arrival, self.scale.length(DETAIL))

    @cached_property
    def others(self) -> dict[str, Run]:
        """The scene file's comparison runs, by name."""
        return scene_runs.open_others(self.settings)

    @property
    def label(self) -> str:
        """Label of the run in comparisons: the name of its folder."""
        return self.settings.run.absolute().name

    def other_runs(self) -> dict[str, Run]:
        """Comparison runs of this shot, by name."""
        return dict(self.others)

    def for_camera(self, name: str) -> Shot:
        """Return a shot with this camera alone. It depends only on this camera and on the one it follows.

        See `comparison.for_view` for views of other runs.
        """
        camera = self.camera(name)
        render = replace(self.settings.render, resolution=self.resolution(camera))
        shot = self.with_settings(replace(self.settings, cameras=(camera,), render=render))
        shot.others = self.others
        return shot

    def for_frames(self, listed: list[int]) -> Shot:
        """Return a subset of a one-camera shot: some of its filmed frames, ascending.

        Paths, smoke and light are of the full shot. Terrain, plants and flames cover these frames only.
        """
        (camera,) = self.settings.cameras
        camera = replace(camera, frames=FrameList(",".join(map(str, listed))))
        shot = self.with_settings(replace(self.settings, cameras=(camera,)))
        shot.full, shot.paths = self, [replace(self.paths[0], camera=camera)]
        return shot

    def with_settings(self, settings: Settings) -> Shot:
        """Return a shot with other settings that shares terrain, fire and scale with this one."""
        shot = Shot(settings, self.run)
        shot.relief, shot.fire, shot.bare_ground = self.relief, self.fire, self.bare_ground
        shot.scale, shot.arrival, shot.cameras = self.scale, self.arrival, self.cameras
        if settings.fire == self.settings.fire:
            shot.__dict__ |= {name: self.__dict__[name] for name in _OF_FIRE if name in self.__dict__}
        return shot

    def camera(self, name: str) -> Camera:
        """Look up a camera by name. A view of a comparison run has its own name.

        Raises
        ------
        UsageError
            No camera has this name.
        """
        known, _, _ = name.partition("@")
        views = scene_runs.views(self.settings)
        for camera in self.settings.cameras:
            if camera.name == name:
                return camera
            if camera.name == known and name in views:
                return replace(camera, name=name)
        names = ", ".join(views) or "none"
        raise UsageError(f'--camera: there is no "{name}"; the scene has {names}')

    def resolution(self, camera: CameraSettings) -> tuple[int, int]:
        """Picture width and height of a camera, pixels."""
        return self.filming.resolution(camera)

    def frames_of(self, camera: CameraSettings) -> list[int]:
        """Frames that a camera films, ascending, from 1."""
        return FrameList(camera.frames).frames(self.frames.count)

    def filmed(self, path: Path) -> NDArray[np.int64]:
        """Frames that a path's camera films, counted from 0, as indices into the path's arrays."""
        listed = path.camera.frames
        if listed not in self._filmed:
            self._filmed[listed] = np.array(self.frames_of(path.camera)) - 1
        return self._filmed[listed]

    def run_of(self, view: str) -> Run:
        """Run of a view: the first run, or the comparison run that ``camera@run`` names."""
        return self.others.get(view.partition("@")[2], self.run)

    def utc(self, frame: float) -> datetime:
        """UTC time of a frame."""
        return times.utc(self.run, self.frames.time(frame))

    @cached_property
    def built_frames(self) -> NDArray[np.int64]:
        """Frames, from 0, for which terrain, plants and flames are built: all, or a subset."""
        return np.arange(self.frames.count) if self.full is self else self.filmed(self.paths[0])

    @property
    def built_times(self) -> NDArray[np.float64]:
        """Model times of the built frames, s."""
        return self.frames.times[self.built_frames]

    @cached_property
    def local_frame(self) -> geo.LocalFrame:
        """Local east-north-up frame of the scene."""
        return local_frame(self.run)

    @cached_property
    def bare_ground(self) -> Terrain:
        """Terrain without camera-dependent detail."""
        arrival = self.fire.arrival
        never = np.full(arrival.shape, np.nan)
        land = cached_in_film("land", self, lambda: Terrain(self.settings, self.run, never, self.relief))
        return land.with_fire(self.run, arrival)

    @cached_property
    def front(self) -> flame_depth.FrontFields:
        """Fire front properties (rate of spread, residence time) on the terrain grid."""
        return flame_depth.FrontFields(self.bare_ground, self.run)

    @cached_property
    def flame_length(self) -> NDArray[np.float64]:
        """Mean flame length (ny, nx), m, on the terrain grid, as if the front were there."""
        return flame_state.mean_length(self)

    @cached_property
    def front_scale(self) -> float:
        """Pattern size of flaming front and burn scar relative to a crown fire's, at most 1."""
        return flame_depth.scale(self.full.front, *self.full.frames.span)

    @cached_property
    def ground(self) -> Terrain:
        """Terrain with added detail near the cameras' paths."""
        rough = self._paths(self.bare_ground) if self.full is self else self.paths
        radius = self.settings.terrain.near_radius
        near = [
            path.near_terrain(view, view.position[self.filmed(view)], self.bare_ground, radius)
            for view in rough
            if view.perspective
        ]
        return self.bare_ground.seen_from(path.eyes(near, radius))

    @cached_property
    def paths(self) -> list[Path]:
        """Camera paths over the terrain, one for each camera."""
        return self._paths(self.ground)

    @cached_property
    def pixel(self) -> tuple[float, float]:
        """Smallest pixel size: m per m of distance in perspective, and m in orthographic views."""
        return path.finest(self.paths)

    @property
    def filming(self) -> Filming:
        """Inputs of the cameras' paths."""
        settings = self.settings
        return Filming(self.run, self.frames, self.cameras, settings.render.resolution, settings.seed)

    def _paths(self, ground: Terrain) -> list[Path]:
        return [
            replace(camera.rig.path(camera, self.filming, ground), width=self.resolution(camera)[0])
            for camera in self.settings.cameras
        ]

    def warnings(self) -> list[str]:
        """Warnings about the scene file, the run's fire, its smoke, and the camera paths."""
        smoke = self.settings.smoke
        cell = max(burning.fuel_cell(self.run))
        coarse = smoke_scale.warnings(self.scale, cell) if smoke.enabled else []
        return [
            *self.settings.notes,
            *run_warnings.of_fire(self.run),
            *coarse,
            *camera_warnings.ridges(self.paths, self.ground),
        ]

    @property
    def perspective_paths(self) -> list[Path]:
        """Paths of the perspective cameras, the only ones that objects can be close to."""
        return [view for view in self.paths if view.perspective]

    @property
    def beyond(self) -> bool:
        """True if a camera sees the Earth beyond the terrain."""
        return any(view.beyond for view in self.paths)

    @cached_property
    def visibility(self) -> Visibility:
        """Visibility of objects in the filmed frames."""
        return Visibility(
            self.paths,
            self.filmed,
            [self.resolution(path.camera)[1] for path in self.paths],
            self.ground,
            self.run,
            self.frames.times,
            error_bounds(self.settings.terrain.error, self.pixel),
            self.settings.render.cull,
        )

    @cached_property
    def wind(self) -> tuple[float, float]:
        """Mean wind near the fire at the middle of the shot, m/s east and north."""
        east, north = burning.wind_at(self.run, np.array([self.frames.middle]), self.fire.surroundings)[0]
        return float(east), float(north)

    @cached_property
    def air(self) -> air_temperature.OverShot:
        """Air temperature over the shot."""
        return air_temperature.OverShot(self.run, self.frames)

    @cached_property
    def fire_distance(self) -> float:
        """Distance of the cameras to the fire, m: 10th percentile of the cells in the closest frame."""
        distances = [
            self._distance_to_fire(view, 10.0)
            if view.perspective
            else 2.0 * view.half[0] * WIDE_LENS / SENSOR  # equal pixel size of the reference lens
            for view in self.paths
        ]
        return min(distances) if distances and len(self._burning_places) else _NO_FIRE_DISTANCE

    @cached_property
    def nearest_fire(self) -> list[float]:
        """Distances of the perspective cameras to the nearest fire, m: 2nd percentile of the cells."""
        return [self._distance_to_fire(view, 2.0) for view in self.perspective_paths]

    @cached_property
    def _burning_places(self) -> NDArray[np.float64]:
        """Positions (n, 3) of cells that burn in the shot or shortly before, m."""
        return self.fire.cells(self.frames.first - 1800.0, self.frames.last + 1.0).position[::5]

    def _distance_to_fire(self, path: Path, percent: float) -> float:
        """Return a percentile of the distances of burning cells in a camera's closest frame, m."""
        if not len(self._burning_places):
            return _NO_FIRE_DISTANCE
        return float(np.percentile(self.visibility.distance_from(path, self._burning_places), percent))
