"""Scene files of a story's shots, which the render job renders: shots/NAME.toml, with one camera each.

A scene file that is there keeps its settings and its camera, unless the storyboard names another camera.
Times and quality follow the storyboard.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from firetwin_core.run import Run

from .. import auto_framing, output
from ..auto_framing import candidates
from ..ellipsoid import metres_per_degree
from ..errors import input_error
from ..run import labels, times
from ..run.frame import local_frame
from ..shot.cameras.rigs._key import CameraKey
from ..shot.cameras.rigs.drone import Drone
from ..shot.cameras.rigs.globe import Globe
from ..shot.cameras.rigs.satellite import Satellite
from ..shot.frames import TIME_LAPSE
from ..shot.sections import Time
from ..shot.settings import Camera, Settings, scene_file, toml_update, toml_writer
from ..shot.shot import Shot
from . import timeline
from .quality import Quality
from .storyboard import ABOVE, FLIGHT, GLOBE, GROUND, SCENE, Storyboard, StoryShot
from .timeline import Span

FOLDER = "shots"
_MAST = 30.0  # m above a place, of a camera there
_ROOM = 1.35  # of the burned ground's size, width of the view from above
_LEAST = 500.0  # m, size of a burned ground
_FAR, _HIGH = 1.2, 0.8  # of the fire's size, distance and height at which the flight from space ends
_AIM = 30.0  # m above the ground, of a camera that looks at the fire
_ASKED = (
    "run",
    *(f"time.{name}" for name in ("start", "end", "frames", "fps", "zone")),
    *(f"render.{name}" for name in ("resolution", "samples", "passes")),
    *(f"cameras.{name}" for name in ("name", "focal_length")),
)


@dataclass(frozen=True)
class Scenes:
    """Scene files of the shots of a story.

    Attributes
    ----------
    fit_again
        Fit cameras again, also of scene files that are there.
    """

    story: Storyboard
    run: Run
    quality: Quality
    fit_again: bool = False

    def path(self, shot: StoryShot) -> Path:
        """Return the path of a shot's scene file."""
        return self.story.path.parent / FOLDER / f"{shot.name}.toml"

    def write(self, span: Span) -> Settings:
        """Write the scene file of a shot, and return its settings.

        Raises
        ------
        InputError
            A place or camera of the shot is unknown, or the file cannot be written.
        """
        path = self.path(span.shot)
        there = scene_file.read(path) if path.is_file() and not self.fit_again else None
        if there is not None and [camera.name for camera in there.cameras] == [span.shot.camera]:
            settings = self._with_times(there, span)
            text = toml_update.updated(path.read_text(encoding="utf-8"), settings)
        else:
            settings = self._with_times(replace(self._scene(span.shot), path=path), span)
            text = toml_writer.brief(
                settings, _ASKED, {"run": f"The shot {span.shot.name} of {self.story.path.name}."}
            )
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            output.write_text(path, text, overwrite=True, newline="\n")
        return settings

    def _with_times(self, settings: Settings, span: Span) -> Settings:
        """Set the times and the quality of a shot."""
        shot, quality = span.shot, self.quality
        assert shot.end
        smoke = replace(
            settings.smoke, enabled=shot.smoke and settings.smoke.enabled, method=quality.smoke_method
        )
        shutter = None if shot.speed > TIME_LAPSE[0] else 0.0  # else frames that stand for several would blur
        return replace(
            settings,
            time=Time(
                shot.start,
                shot.end,
                quality.pictures(span, self.story.fps),
                fps=self.story.fps,
                shutter=shutter,
                zone=self.story.zone,
            ),
            smoke=smoke,
            render=replace(
                settings.render,
                resolution=quality.resolution,
                samples=quality.samples,
                passes=(shot.render_pass,),
                video=False,
            ),
        )

    def _scene(self, shot: StoryShot) -> Settings:
        """Fit settings with the camera of a shot."""
        own = {camera.name: camera for camera in self._base.cameras} if self.story.scene else {}
        if shot.camera in own:
            return replace(self._base, cameras=(replace(own[shot.camera], passes=()),))
        settings = auto_framing.fit_draft(self.run, self._base)
        own_rigs = {GLOBE: self._globe, GROUND: self._ground, ABOVE: self._above, FLIGHT: self._flight}
        make_rig = own_rigs.get(shot.camera, self._placed)
        return replace(settings, cameras=(Camera(shot.camera, rig=make_rig(shot)),))

    @property
    def _base(self) -> Settings:
        """Settings of the scene file, or of a run without one."""
        if self.story.scene is not None:
            return replace(scene_file.read(self.story.scene), runs=())
        folder = self.story.path.parent
        return Settings(path=folder / "scene.toml", run=self.story.run, cache=folder / "cache")

    def _fitted(self, shot: StoryShot) -> Settings:
        """Fit cameras to the times of a shot."""
        time = Time(shot.start, shot.end, auto_framing.window.FRAMES, fps=auto_framing.window.FPS)
        return _fit(self.run, replace(self._base, time=time))

    def _placed(self, shot: StoryShot) -> Any:
        """Fit the camera of auto framing that a shot names."""
        return _rig(self._fitted(shot), shot, self.story.path)

    def _flight(self, shot: StoryShot) -> Drone:
        """Fly from the overview of a shot to the first view of the next rendered shot."""
        ahead = self._next(shot)
        fitted = self._fitted(ahead)
        overview = _rig(fitted, replace(shot, camera="overview"), self.story.path)
        camera = next((each for each in fitted.cameras if each.name == ahead.camera), fitted.cameras[0])
        span = next(each for each in timeline.lay_out(self.story) if each.shot.name == ahead.name)
        # A chase depends on the number of pictures, over which it is smoothed.
        filmed = Shot(
            self._with_times(replace(fitted, cameras=(camera,)), replace(span, shot=ahead)), self.run
        )
        view = camera.rig.path(camera, filmed.filming, filmed.bare_ground)
        (latitude, longitude, _), (aim_latitude, aim_longitude, _) = (
            tuple(float(each[0]) for each in local_frame(self.run).reverse(at[:1]))
            for at in (view.position, view.target)
        )
        ground = filmed.bare_ground
        above = float((view.position[0, 2] - ground.up(*view.position[:1, :2].T))[0])
        aim = float((view.target[0, 2] - ground.up(*view.target[:1, :2].T))[0])
        last = CameraKey(1.0, latitude, longitude, max(above, 1.0), "point", aim_latitude, aim_longitude, aim)
        return Drone(focal_length=overview.focal_length, keys=(*overview.keys[:1], last))

    def _next(self, shot: StoryShot) -> StoryShot:
        """Return the next rendered shot with a fitted camera; the shot itself without one."""
        shots = self.story.shots
        later = shots[[each.name for each in shots].index(shot.name) + 1 :]
        placed = (
            each
            for each in later
            if each.picture == SCENE and each.camera not in (GLOBE, FLIGHT, GROUND, ABOVE)
        )
        return next(placed, replace(shot, camera="overview"))

    def _globe(self, shot: StoryShot) -> Globe:
        latitude, longitude, (width, height) = self._burned(self.run.times[-1])
        size = max(width, height)
        return Globe(
            latitude=latitude,
            longitude=longitude,
            distance=candidates.rounded(_FAR * size),
            height=candidates.rounded(_HIGH * size),
            bearing=180.0,
        )

    def _ground(self, shot: StoryShot) -> Drone:
        places = {each.name: each for each in labels.find(self.run, self._base.labels.file)}
        if shot.place not in places:
            reason = (
                f'shots.place "{shot.place}" is not a place of this run; choose one of {", ".join(places)}'
            )
            raise input_error(self.story.path, reason if places else "no place has a name; delete this shot")
        place = places[shot.place]
        key = CameraKey(0.0, place.latitude, place.longitude, _MAST, "fire", target_height=_AIM)
        return Drone(keys=(key,))

    def _above(self, shot: StoryShot) -> Satellite:
        assert shot.end
        latitude, longitude, (width, height) = self._burned(times.seconds(self.run, shot.end))
        across, up = self.quality.resolution
        swath = candidates.rounded(_ROOM * max(width, height * across / up))
        return Satellite(swath=swath, keys=(CameraKey(0.0, latitude, longitude),))

    def _burned(self, time: float) -> tuple[float, float, tuple[float, float]]:
        """Centre (degrees), width and height (m) of ground burned by a model time; all ground without any."""
        run = self.run
        with np.errstate(invalid="ignore"):
            burned = run.fuel_arrival_time() <= time
        if not burned.any():
            burned = np.ones_like(burned)
        sides = [
            axis[np.flatnonzero(burned.any(1 - k))[[0, -1]]]
            for k, axis in enumerate((run.fuel_latitude, run.fuel_longitude))
        ]
        latitude, longitude = (float(side.mean()) for side in sides)
        north, east = metres_per_degree(latitude)
        tall, wide = (
            max(abs(float(np.diff(side)[0])) * m, _LEAST)
            for side, m in zip(sides, (north, east), strict=True)
        )
        return round(latitude, 5), round((longitude + 180.0) % 360.0 - 180.0, 5), (wide, tall)


@functools.lru_cache(maxsize=8)
def _fit(run: Run, settings: Settings) -> Settings:
    """Fit cameras; shots of one window share them."""
    return auto_framing.fit(run, settings).settings


def _rig(fitted: Settings, shot: StoryShot, path: Path) -> Any:
    """Return the rig of a shot's camera among fitted ones.

    Raises
    ------
    InputError
        There is no such camera.
    """
    rigs = {camera.name: camera.rig for camera in fitted.cameras}
    if shot.camera in rigs:
        return rigs[shot.camera]
    known = ", ".join((*rigs, GLOBE, FLIGHT, GROUND, ABOVE))
    raise input_error(path, f'shots.camera "{shot.camera}" of {shot.name} is unknown; choose one of {known}')
