"""What is filmed: settings and run, resolved once. Everything that builds, bakes or renders takes it."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from datetime import datetime
from functools import cached_property

import numpy as np
from firetwin_core import geo
from firetwin_core.run import Run
from numpy.typing import NDArray

from ..errors import UsageError
from ..progress import Progress, silent
from ..run import content, times, zone
from ..run.frame import local_frame
from . import air_temperature, camera_warnings, frames, scene_runs, smoke_scale
from .cameras import path
from .cameras.path import SENSOR, Path
from .fire import burning, flame_depth
from .fire.fire import Fire
from .fire.fuel import DETAIL
from .frames import Frames
from .settings import frame_list
from .settings.protocols import CameraSettings
from .settings.settings import SMOKE_METHODS, Camera, Settings
from .smoke_scale import Scale
from .terrain import elevation
from .terrain.elevation import Elevation
from .terrain.terrain import Ground
from .visibility import Visibility

_BEFORE = 3600.0  # s before the first frame that ground which burned since counts as burning
WIDE_LENS = 28.0  # mm; pictures to scale count as taken with it
_SPIN_UP = 1800.0  # s, of a fire of 15 km
_NOWHERE = 20_000.0  # m, distance of a fire that no camera looks at


class Shot:
    """A scene file and its run.

    What takes time to work out is worked out when it is first asked for, and once.

    Attributes
    ----------
    settings
        The scene file; its clock's zone is the run's where it says none.
    run
        The model run.
    frames
        Frames and the model times that they show.
    relief
        Heights of the ground on the run's grids.
    cameras
        All of the scene file's, also those that are not filmed here: others may follow them.
    full
        The shot that this is a part of; else itself.
    """

    def __init__(self, settings: Settings, run: Run) -> None:
        if not settings.time.zone:
            settings = replace(settings, time=replace(settings.time, zone=zone.time_zone(run)))
        self.settings, self.run, self.cameras, self.full = settings, run, settings.cameras, self
        self.frames: Frames = frames.resolve(settings.time, run)
        self._filmed: dict[str, NDArray[np.int64]] = {}
        self.relief: Elevation = elevation.resolve(settings, run)

    def input_hashes(self, leave_out: Collection[str] = (), progress: Progress = silent) -> dict[str, str]:
        """SHA-256 of each field of the run but some, and of the elevation model."""
        settings = self.settings
        found = content.inputs(self.run, settings.cache, leave_out, progress)
        model = settings.terrain.elevation
        return found | (
            {"elevation model": content.of_file(model, settings.cache, progress)} if model else {}
        )

    @cached_property
    def arrival(self) -> NDArray[np.float64]:
        """(fy, fx) s, when the front passes the middle of each fuel cell; NaN where never."""
        return self.run.fuel_arrival_time()

    @cached_property
    def scale(self) -> Scale:
        """How fine the air over the fire is solved, and its smoke drawn."""
        long = smoke_scale.extent(self.run, self.arrival, self.frames.first, self.frames.last)
        return smoke_scale.choose(long, max(burning.fuel_cell(self.run)), self.settings.smoke.cell_budget)

    @property
    def spin_up(self) -> float:
        """How long before the first frame the flow of smoke begins, s."""
        return self._history("spin_up")

    def _history(self, key: str) -> float:
        """How far back from the first frame (s) a key of [smoke] reaches; left out, by the fire's size."""
        told = getattr(self.settings.smoke, key)
        return self.scale.time(_SPIN_UP) if told is None else told

    @cached_property
    def fire(self) -> Fire:
        """What burns from the first frame to the last; it is there for all cameras."""
        since = self._history(SMOKE_METHODS[self.settings.smoke.method].history)
        before = max(since + burning.BURN_TIME, _BEFORE)
        span = self.frames.first, self.frames.last, before
        return Fire(self.run, *span, self.relief, self.arrival, self.scale.length(DETAIL))

    @cached_property
    def others(self) -> dict[str, Run]:
        """The scene file's other runs by their names."""
        return scene_runs.open_others(self.settings)

    @property
    def label(self) -> str:
        """Name of the run beside others: that of its folder."""
        return self.settings.run.absolute().name

    def other_runs(self) -> dict[str, Run]:
        """The runs that this one stands beside, by name."""
        return dict(self.others)

    def for_camera(self, name: str) -> Shot:
        """The same shot with this camera alone: what it films depends on no other but that it follows.

        See `comparison.for_view` for views of other runs.
        """
        camera = self.camera(name)
        render = replace(self.settings.render, resolution=self.resolution(camera))
        shot = self._sharing(replace(self.settings, cameras=(camera,), render=render))
        shot.others = self.others
        return shot

    def for_frames(self, listed: list[int]) -> Shot:
        """The same shot of one camera, for some of the frames that it films, ascending.

        Paths, smoke and light stay those of the whole; ground, plants and flames are what these frames show.
        """
        (camera,) = self.settings.cameras
        camera = replace(camera, frames=",".join(map(str, listed)))
        shot = self._sharing(replace(self.settings, cameras=(camera,)))
        shot.full, shot.paths = self, [replace(self.paths[0], camera=camera)]
        return shot

    def _sharing(self, settings: Settings) -> Shot:
        """A shot of these settings that shares ground, fire and scale with this one."""
        shot = Shot(settings, self.run)
        shot.relief, shot.fire, shot.bare_ground = self.relief, self.fire, self.bare_ground
        shot.scale, shot.arrival, shot.cameras = self.scale, self.arrival, self.cameras
        return shot

    def camera(self, name: str) -> Camera:
        """The camera of this name; in another run it has the name of that view.

        Raises
        ------
        UsageError
            There is none.
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
        """Width and height (pixels) of a camera's pictures."""
        return camera.resolution or self.settings.render.resolution

    def frames_of(self, camera: CameraSettings) -> list[int]:
        """Frames that a camera films, ascending."""
        return frame_list.parse(camera.frames, self.frames.count)

    def filmed(self, path: Path) -> NDArray[np.int64]:
        """The frames that a path's camera films, from 0, as its arrays count them."""
        listed = path.camera.frames
        if listed not in self._filmed:
            self._filmed[listed] = np.array(self.frames_of(path.camera)) - 1
        return self._filmed[listed]

    def utc(self, frame: float) -> datetime:
        """UTC of a frame."""
        return times.utc(self.run, self.frames.time(frame))

    @cached_property
    def built_frames(self) -> NDArray[np.int64]:
        """Frames, from 0, that ground, plants and flames are built for: all, or those that a part films."""
        return np.arange(self.frames.count) if self.full is self else self.filmed(self.paths[0])

    @property
    def built_times(self) -> NDArray[np.float64]:
        """Model times (s) of the frames that are built."""
        return self.frames.times[self.built_frames]

    @cached_property
    def local_frame(self) -> geo.LocalFrame:
        """The scene's east, north and up."""
        return local_frame(self.run)

    @cached_property
    def bare_ground(self) -> Ground:
        """The ground without the detail near cameras."""
        return Ground(self.settings, self.run, self.fire.arrival, self.relief)

    @cached_property
    def front(self) -> flame_depth.Fields:
        """How the front goes over the ground's grid."""
        return flame_depth.Fields(self.bare_ground, self.run)

    @cached_property
    def front_scale(self) -> float:
        """Size of what is seen of the front and the scar beside that of a crown fire's, to 1."""
        return flame_depth.scale(self.full)

    @cached_property
    def ground(self) -> Ground:
        """The ground, with detail along the cameras' paths."""
        rough = self._paths(self.bare_ground) if self.full is self else self.paths
        near = [view.position[self.filmed(view)] for view in rough if view.perspective]
        return self.bare_ground.seen_from(path.eyes(near, self.settings.terrain.near_radius))

    @cached_property
    def paths(self) -> list[Path]:
        """Paths of all cameras over the ground."""
        return self._paths(self.ground)

    @cached_property
    def pixel(self) -> tuple[float, float]:
        """Sizes of the smallest pixels: in perspective m per m of distance, with parallel lines m."""
        return path.finest(self.paths)

    def _paths(self, ground: Ground) -> list[Path]:
        return [
            replace(camera.rig.path(camera, self, ground), width=self.resolution(camera)[0])
            for camera in self.settings.cameras
        ]

    def warnings(self) -> list[str]:
        """What an artist should know of the scene file and of the cameras' paths."""
        return [*self.settings.notes, *camera_warnings.ridges(self)]

    @property
    def perspective_paths(self) -> list[Path]:
        """Paths of the cameras that things can be near to."""
        return [view for view in self.paths if view.perspective]

    @cached_property
    def visibility(self) -> Visibility:
        """What the cameras see in the frames that they film, and how near they come."""
        return Visibility(self)

    @cached_property
    def wind(self) -> tuple[float, float]:
        """Mean wind (m/s, east and north) where it burns in the middle of the shot."""
        east, north = burning.wind_at(self.run, np.array([self.frames.middle]), self.fire.surroundings)[0]
        return float(east), float(north)

    @cached_property
    def air(self) -> air_temperature.OverShot:
        """Temperatures of the air over the shot."""
        return air_temperature.OverShot(self.run, self.frames)

    @cached_property
    def fire_distance(self) -> float:
        """How near (m) cameras come to the fire: nearer than nine tenths of it in their nearest frame."""
        cells = self.fire.cells(self.frames.first - 1800.0, self.frames.last + 1.0)
        if not self.paths or len(cells.arrival) == 0:
            return _NOWHERE
        return min(
            float(np.percentile(self.visibility.distance_from(view, cells.position[::5]), 10.0))
            if view.perspective
            else 2.0 * view.half[0] * WIDE_LENS / SENSOR  # as a lens with pixels as large on the ground
            for view in self.paths
        )
