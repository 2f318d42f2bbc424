"""Scene file of a clip."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from firetwin_core.run import Run

from ...run import times, zone
from ...run.frame import local_frame
from ...shot.cameras.rigs._key import CameraKey
from ...shot.cameras.rigs.drone import Drone
from ...shot.sections import Time
from ...shot.settings import Camera, Settings, toml_writer
from .. import candidates
from .kinds import FireKind
from .places import FPS, FRAMES
from .placing import PlacedView
from .search import Clip

_AIM = 0.5  # height of the aim over the flames' height
_CLEARANCE = 0.7  # of the camera's height
_ASKED = (
    "run",
    *(f"time.{name}" for name in ("start", "frames", "fps", "speed", "zone")),
    *(f"render.{name}" for name in ("resolution", "samples", "passes")),
    *(f"cameras.{name}" for name in ("name", "focal_length")),
    *(f"cameras.keys.{name}" for name in ("latitude", "longitude", "height")),
)


def scene_text(run: Run, settings: Settings, kind: FireKind, clip: Clip, path: Path) -> str:
    """Write the scene file `path` of a clip of a kind of fire."""
    there = zone.time_zone(run)
    start = times.utc(run, round(clip.fire.first, 3))
    whole = replace(
        settings,
        path=path,
        time=Time(start=start, frames=FRAMES, fps=FPS, speed=1.0, zone=there),
        render=replace(settings.render, samples=8, passes=("rgb",)),
        cameras=tuple(camera(run, kind, view) for view in clip.placed),
    )
    head = (
        f"{kind.words[:1].upper()}{kind.words[1:]}, {times.text(start, there, seconds=True)}: "
        "four seconds in real time.\n"
        f"`firetwin render {path.name} --out {path.stem} --frames 1` renders a still of each camera.\n"
        "Keys that are not here have their defaults, which examples/king_fire.toml explains."
    )
    remarks = {_name(kind, view): _words(view) for view in clip.placed}
    return toml_writer.brief(whole, _ASKED, {"run": head} | remarks)


def _name(kind: FireKind, view: PlacedView) -> str:
    distance = f"{view.distance:.0f}m" if view.distance < 1000.0 else f"{view.distance / 1000.0:g}km"
    return f"{kind.name}_{distance}"


def camera(run: Run, kind: FireKind, view: PlacedView) -> Camera:
    """Return the camera of a view."""
    frame = local_frame(run)
    (latitude, longitude), (aim_latitude, aim_longitude) = (
        tuple(round(float(v[0]), 7) for v in frame.reverse(place[None])[:2])
        for place in (view.eye, view.target)
    )
    above, aim = round(view.above, 1), round(_AIM * view.flame, 1)
    key = CameraKey(0.0, latitude, longitude, above, "point", aim_latitude, aim_longitude, aim)
    lens = float(candidates.rounded(view.focal_length))
    rig = Drone(focal_length=lens, clearance=round(_CLEARANCE * above, 1), keys=(key,))
    return Camera(_name(kind, view), rig=rig)


def _words(view: PlacedView) -> str:
    return (
        f"From the {candidates.side(view.bearing)}, {view.above:,.1f} m up; flames are up to about "
        f"{view.flame:.2g} m high, and {candidates.percent(view.share)} of them are clear of terrain "
        "and plants."
    )
