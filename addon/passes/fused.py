"""Fused pass: visible, thermal, depth and map panels of a camera in one picture, with time and position.

The picture has the camera's size, and at least 720 rows for legibility. Depth has the same colours in every
frame of a shot; temperatures have the colours of the thermal pass. Sensors on the camera's mount supply
passes that it does not record (see `shot.cameras.mount`). All panels are registered: a point has the same
position in each. A sensor with a smaller field of view fills its part of the panel and is outlined in the
visible picture. The map is the picture of a minimap that follows the camera; else relief and canopy of the
run, north up, around the camera. It shows the front, the burned area (the last half hour in orange), the
camera, its path and field of view.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from firetwin_core import sensor

from ..run import info, times
from ..shot import passes, picture_credits
from ..shot.cameras import pixel_rays
from ..shot.cameras.path import Path
from ..shot.passes import DerivedPass, Files
from ..shot.settings import mount
from ..shot.shot import Shot
from . import pose, thermal

ORDER = 60
HELP = "One picture of visible, thermal, depth and a map, with time, place and scales"

PASS = DerivedPass(
    files=("png",),
    film=True,
    captions=False,
    aspects=frozenset({"time", "camera", "film", "terrain", "thermal"}),
    needs=("rgb", "thermal", "depth"),
    mount=True,
    single_view=True,
    min_rows=720,
    code=("shot/cameras/rigs/mounted.py", "shot/cameras/rigs/minimap.py", "passes/pose.py"),
)

_ABOVE = {"orthometric": "MSL", "ellipsoidal": "WGS84"}
_POINTS = ("N", "NE", "E", "SE", "S", "SW", "W", "NW")


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Compose the panels."""
    from ..imaging.sheet import Sheet
    from . import _map

    view = pixel_rays.path_of(shot.paths, camera)
    made = passes.known()["fused"]
    taken = mount.taken(shot.settings, shot.cameras, camera, made)
    low, high = thermal.scale(shot, frame)
    size = made.size(shot.resolution(view.camera))
    sheet = Sheet(*size, picture_credits.foot(shot, *size))
    sheet.head(_title(shot, camera), facts(shot, camera, frame))
    rgb = sensor.read_image(needed["rgb"]["png"])[..., :3]
    kelvin = sensor.read_image(needed["thermal"]["exr"])[..., 0]
    depth = sensor.read_image(needed["depth"]["exr"])[..., 1]
    pixels = {"rgb": rgb, "thermal": kelvin, "depth": depth}
    parts = {need: _part(shot, view, frame, taken[need][0], pixels[need].shape) for need in pixels}
    sheet.picture(0, "VISIBLE", rgb, parts["rgb"], outlined={part: need for need, part in parts.items()})
    palette, cold = shot.settings.thermal.palette, thermal.cold_range(shot)
    sheet.thermal(1, kelvin, low, high, palette, thermal.KNEE, cold, parts["thermal"])
    sheet.depth(3, depth, pixel_rays.SKY, parts["depth"])
    panel = sheet.panel(2, "MAP")
    if mount.MAP in taken:
        photo = sensor.read_image(needed[mount.MAP]["png"])[..., :3]
        _map.draw(panel, shot, view, frame, photo, _rig(shot, taken[mount.MAP][0]).swath)
    else:
        _map.draw(panel, shot, view, frame)
    sensor.write_image(files["png"], sheet.pixels())


def _part(shot: Shot, view: Path, frame: int, name: str, shape: tuple[int, ...]) -> tuple[float, float]:
    """Compute the fraction of a camera's view, across and up, that a sensor on its mount covers."""
    if name == view.camera.name:
        return 1.0, 1.0
    across, up = view.halves[frame - 1]
    own = _rig(shot, name).through(view).halves[frame - 1, 0]
    return float(own / across), float(own * shape[0] / shape[1] / up)


def _rig(shot: Shot, name: str) -> Any:
    return next(camera.rig for camera in shot.cameras if camera.name == name)


def _title(shot: Shot, camera: str) -> str:
    made_up = " (synthetic)" if shot.run.synthetic and "synthetic" not in shot.run.name.lower() else ""
    return f"{shot.run.name}{made_up}  ·  {camera}"


def facts(shot: Shot, camera: str, frame: int) -> list[tuple[str, list[str]]]:
    """Collect the facts next to the panels, each with label and lines; the first is the time."""
    view, moment = pixel_rays.path_of(shot.paths, camera), shot.utc(frame)
    here = pose.pose(shot, view, frame)
    places = (("latitude", "NS"), ("longitude", "EW"))
    degrees = [f"{abs(here[name]):.5f}° {signs[here[name] < 0.0]}" for name, signs in places]
    heading, height = here["heading"], f"{here['height']:,.0f} m {_ABOVE[shot.run.vertical]}"
    pitch = f"pitch {here['pitch']:+.0f}°".replace("-", "\N{MINUS SIGN}")
    acres = info.burned(shot.run, [shot.frames.time(frame)])[0] / info.ACRE
    rows = [
        ("TIME", [times.text(moment, shot.settings.time.zone), f"{moment:%Y-%m-%d %H:%M:%S} UTC"]),
        ("POSITION", degrees),
        ("HEIGHT", [f"{here['height_above_ground']:,.0f} m AGL", height]),
        ("HEADING", [f"{heading:03.0f}° {_POINTS[round(heading / 45.0) % 8]}", pitch]),
        ("BURNED", [f"{acres:,.0f} acres"]),
    ]
    if shot.speed > 0.0:
        rows.append(("FILM", [f"{float(f'{shot.speed:.3g}'):,g}× as fast"]))  # ",.3g" would print 1.12e+04
    if view.perspective:
        across = 2.0 * np.degrees(np.arctan(view.halves[frame - 1, 0]))
        rows.insert(4, ("VIEW", [f"{across:.0f}° wide"]))
    return rows
