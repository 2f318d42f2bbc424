"""Scene files of a story's shots, which the render job renders: shots/NAME.toml, with one camera each.

A scene file that is there keeps its settings and its camera, unless the storyboard names another camera.
Times and quality follow the storyboard.
"""

from __future__ import annotations

import functools
import os
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
from firetwin_core.run import Run

from .. import auto_framing, output
from ..auto_framing import candidates, fire_views
from ..ellipsoid import metres_per_degree
from ..errors import input_error
from ..run import areas, labels, observations, times
from ..run.frame import local_frame
from ..shot import passes
from ..shot.cameras.rigs._key import CameraKey
from ..shot.cameras.rigs.drone import Drone
from ..shot.cameras.rigs.globe import Globe
from ..shot.cameras.rigs.satellite import Satellite
from ..shot.fire import flame_map
from ..shot.frames import TIME_LAPSE
from ..shot.sections import ForecastSettings, Time
from ..shot.settings import Camera, Settings, scene_file, toml_update, toml_writer
from ..shot.shot import Shot
from . import evidence
from .quality import Quality
from .storyboard import ABOVE, CAMERAS, FLIGHT, FRONT, GLOBE, GOES, GROUND, NEAR, SCENE, Storyboard, StoryShot
from .timeline import Span

FOLDER = "shots"
_MAST = 30.0  # m above a place, of a camera there
_ROOM = 1.7  # of the burned ground's size, width of the view from above
_OBLIQUE = 0.8  # of that width, of a geostationary imager, which sees the ground foreshortened
_LOW = 0.14  # of the picture's height, the burned ground above the picture's centre: captions are below
_LEAST = 500.0  # m, size of a burned ground
_FAR, _HIGH = 1.2, 0.8  # of the fire's size, distance and height at which the flight from space ends
_LINE = 200.0  # of the picture's width from above, width of observed perimeters
_TALL = 0.02  # of the picture's height, flames in a chase below which the overview is better (by eye)
_TALLEST = 90  # percentile of the flames' lengths, the length of a fire's flames
_FLAMES = timedelta(seconds=60.0)  # time before a shot of flames in which they reach its place
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
            A place or camera of the shot is unknown, or the file is of others or cannot be written.
        """
        path = self.path(span.shot)
        there = scene_file.read(path) if path.is_file() and not self.fit_again else None
        if there is not None and [camera.name for camera in there.cameras] == [span.shot.camera]:
            settings = self._with_times(there, span)
            text = toml_update.updated(path.read_text(encoding="utf-8"), settings)
        else:
            if os.path.lexists(path) and not self.fit_again and not output.is_own(path):
                raise input_error(path, f"has another camera than {span.shot.camera}; rename or delete it")
            settings = self._with_times(replace(self._scene(span.shot), path=path), span)
            text = toml_writer.brief(
                settings, _ASKED, {"run": f"The shot {span.shot.name} of {self.story.path.name}."}
            )
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            output.write_text(path, text, overwrite=True)
        return settings

    def _with_times(self, settings: Settings, span: Span) -> Settings:
        """Set the times and the quality of a shot."""
        shot, quality, lapse = span.shot, self.quality, span.shot.speed > TIME_LAPSE[0]
        assert shot.end
        method = "preview" if lapse else quality.smoke_method
        smoke = replace(settings.smoke, enabled=shot.smoke and settings.smoke.enabled, method=method)
        shutter = None if lapse else 0.0  # else frames that stand for several would blur
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
                passes=self.story.passes_of(shot),
                video=False,
            ),
        )

    def _scene(self, shot: StoryShot) -> Settings:
        """Fit settings with the camera of a shot."""
        base = self._inputs(shot)
        own = {camera.name: camera for camera in base.cameras} if self.story.scene else {}
        if shot.camera in own:
            return replace(base, cameras=(replace(own[shot.camera], passes=()),))
        settings = auto_framing.fit_draft(self.run, base)
        own_rigs = {
            GLOBE: self._globe,
            NEAR: self._near,
            GROUND: self._ground,
            ABOVE: self._above,
            FLIGHT: self._flight,
            GOES: self._goes,
        }
        rig = own_rigs.get(shot.camera, self._placed)(shot)
        if shot.observed and isinstance(rig, Satellite):
            width = max(settings.fire.observed_width, candidates.rounded(rig.swath / _LINE))
            settings = replace(settings, fire=replace(settings.fire, observed_width=width))
        return replace(settings, cameras=(Camera(shot.camera, rig=rig),))

    def _inputs(self, shot: StoryShot) -> Settings:
        """Return the settings with the other runs, members and perimeters that a shot shows."""
        settings, drawn = self._settings, passes.known()[shot.render_pass]
        if not passes.compares(shot.render_pass):
            settings = replace(settings, runs=())
        if "forecast" not in drawn.all_aspects:  # its times would limit the shot's
            settings = replace(settings, forecast=ForecastSettings())
        lines = settings.fire.observed or Path(self.run.path) / observations.FOLDER
        fire = replace(
            settings.fire, observed=lines if shot.observed else None
        )  # near cameras they hide flames
        return replace(settings, fire=fire)

    @property
    def _settings(self) -> Settings:
        """Settings of the scene file, or of a run without one."""
        if self.story.scene is not None:
            return scene_file.read(self.story.scene)
        folder = self.story.path.parent
        return Settings(path=folder / "scene.toml", run=self.story.run, cache=folder / "cache")

    def _fitted(self, shot: StoryShot) -> Settings:
        """Fit cameras to the times of a shot; of a time-lapse, to its last minute, with all burned ground."""
        start, end = shot.start, shot.end
        assert end
        if shot.speed > TIME_LAPSE[0]:
            start = end - timedelta(minutes=1)
        time = Time(start, end, auto_framing.window.FRAMES, fps=auto_framing.window.FPS)
        plain = replace(self._settings, runs=(), forecast=ForecastSettings())
        return _fit(self.run, replace(plain, time=time))

    def _placed(self, shot: StoryShot) -> Any:
        """Fit the camera of auto framing that a shot names."""
        return _rig(self._fitted(shot), self.run, shot, self.story.path)

    def _flight(self, shot: StoryShot) -> Drone:
        """Fly from the overview of a shot to the first view of the next rendered shot."""
        ahead = self._next(shot)
        fitted = self._fitted(ahead)
        overview = _rig(fitted, self.run, replace(shot, camera="overview"), self.story.path)
        rig = self._near(ahead) if ahead.camera == NEAR else _rig(fitted, self.run, ahead, self.story.path)
        if rig == overview:  # then it flies to the flank
            rig = next((each.rig for each in fitted.cameras if each.name == "flank"), rig)
        camera = Camera(ahead.camera, rig=rig)
        filmed = Shot(replace(fitted, cameras=(camera,)), self.run)
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
            each for each in later if each.picture == SCENE and each.camera not in {*CAMERAS} - {FRONT, NEAR}
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

    def _near(self, shot: StoryShot) -> Any:
        """Look at the best flames of the minute before a shot."""
        assert shot.start
        near = _near_view(self.run, self.story.path.parent / "cache", shot.start)
        if near is None:
            reason = f"{shot.name}: no camera has a clear view of flames then"
            raise input_error(self.story.path, f"{reason}; change shots.start, or delete the shot")
        return near.camera.rig

    def _ground(self, shot: StoryShot) -> Drone:
        places = {each.name: each for each in labels.find(self.run, self._settings.labels.file)}
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
        latitude -= _LOW * swath * up / across / metres_per_degree(latitude)[0]
        return Satellite(swath=swath, keys=(CameraKey(0.0, round(latitude, 5), longitude),))

    def _goes(self, shot: StoryShot) -> Satellite:
        rig, longitude = self._above(shot), evidence.goes(self.run)[1]
        return replace(rig, swath=candidates.rounded(_OBLIQUE * rig.swath), geostationary=longitude)

    def _burned(self, time: float) -> tuple[float, float, tuple[float, float]]:
        """Centre (degrees), width and height (m) of ground burned by a model time; all ground without any."""
        run = self.run
        with np.errstate(invalid="ignore"):
            burned = run.fuel_arrival_time() <= time
        latitude, longitude, size = areas.bounds(run.fuel_latitude, run.fuel_longitude, burned)
        wide, tall = (max(side, _LEAST) for side in size)
        return round(latitude, 5), round((longitude + 180.0) % 360.0 - 180.0, 5), (wide, tall)


@functools.lru_cache(maxsize=8)
def _fit(run: Run, settings: Settings) -> Settings:
    """Fit cameras; shots of one window share them."""
    return auto_framing.fit(run, settings).settings


@functools.lru_cache(maxsize=8)
def _near_view(run: Run, cache: Path, start: datetime) -> fire_views.NearView | None:
    """Find a view of flames that reach their place in the minute before a time; shots share it."""
    asked = start - _FLAMES, start + timedelta(seconds=fire_views.places.SECONDS)
    return fire_views.find_near_view(run, cache, asked)


def _rig(fitted: Settings, run: Run, shot: StoryShot, path: Path) -> Any:
    """Return the rig of a shot's camera among fitted ones.

    Raises
    ------
    InputError
        There is no such camera.
    """
    rigs = {camera.name: camera.rig for camera in fitted.cameras}
    name = _front(fitted, run) if shot.camera == FRONT else shot.camera
    if name in rigs:
        return rigs[name]
    known = ", ".join(dict.fromkeys((*rigs, *CAMERAS)))
    raise input_error(path, f'shots.camera "{shot.camera}" of {shot.name} is unknown; choose one of {known}')


@functools.lru_cache(maxsize=8)
def _front(fitted: Settings, run: Run) -> str:
    """Return the name of the camera of the front: the chase, or the overview if flames are low in it."""
    chase = next((camera for camera in fitted.cameras if camera.name == "chase"), None)
    if chase is None:
        return "overview"
    shot = Shot(replace(fitted, cameras=(chase,)), run)
    view = chase.rig.path(chase, shot.filming, shot.bare_ground)
    ground, frames = shot.bare_ground, shot.frames
    burns = (ground.arrival >= frames.first) & (ground.arrival <= frames.last)
    lengths = flame_map.cell_lengths(shot.front, fitted.fire.flame_length)[burns]
    away = float(np.linalg.norm(view.position - view.target, axis=1).mean())
    tall = float(np.percentile(lengths, _TALLEST)) if len(lengths) else 0.0
    return "chase" if tall >= _TALL * 2.0 * view.half[1] * away else "overview"
