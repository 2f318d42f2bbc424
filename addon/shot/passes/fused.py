"""All of a camera's feeds in one picture: visible, thermal, depth and a map, with time, place and scales.

The picture is as large as the camera's own, whatever that is. Temperatures and distances have the same
colours in every frame of a shot. The map is drawn from the run, north up, round the camera: relief, canopy,
what has burned (the last half hour in orange), and the camera's way and angle of view.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import Files, Pass, pose

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..shot import Shot

_ABOVE = {"orthometric": "MSL", "ellipsoidal": "WGS84"}
_POINTS = ("N", "NE", "E", "SE", "S", "SW", "W", "NW")


def finish(files: Files, needed: Mapping[str, Files], shot: Shot, camera: str, frame: int) -> None:
    """Put the panels together."""
    from firetwin_core import sensor

    from ...errors import Error

    try:
        from . import _map, _sheet
    except ModuleNotFoundError as error:
        raise Error(f"the fused pass needs {error.name}, which is not in Blender: pip install it") from None
    from . import _view, thermal

    view = _view.of(shot, camera)
    low, high = thermal.scale(shot)
    sheet = _sheet.Sheet(*shot.resolution(view.camera))
    sheet.head(_title(shot, camera), facts(shot, camera, frame))
    sheet.picture(0, "VISIBLE", sensor.read_image(needed["rgb"]["png"])[..., :3])
    kelvin = sensor.read_image(needed["thermal"]["exr"])[..., 0]
    sheet.thermal(1, kelvin, low, high, shot.settings.thermal.palette)
    _map.draw(sheet.panel(2, "MAP"), shot, view, frame)
    sheet.depth(3, sensor.read_image(needed["depth"]["exr"])[..., 1], _view.SKY)
    sensor.write_image(files["png"], sheet.pixels())


def _title(shot: Shot, camera: str) -> str:
    made_up = " (synthetic)" if shot.run.synthetic and "synthetic" not in shot.run.name.lower() else ""
    return f"{shot.run.name}{made_up}  ·  {camera}"


def facts(shot: Shot, camera: str, frame: int) -> list[tuple[str, list[str]]]:
    """What is told beside the panels, each with its name and its lines; the first is the time."""
    import numpy as np

    from ...run import info, times
    from . import _view

    view, moment = _view.of(shot, camera), shot.moment(frame)
    here = pose.pose(shot, view, frame)
    places = (("latitude", "NS"), ("longitude", "EW"))
    degrees = [f"{abs(here[name]):.5f}° {signs[here[name] < 0.0]}" for name, signs in places]
    heading, height = here["heading"], f"{here['height']:,.0f} m {_ABOVE[shot.run.vertical]}"
    pitch = f"pitch {here['pitch']:+.0f}°".replace("-", "\N{MINUS SIGN}")
    acres = info.burned(shot.run, [shot.frames.time(frame)])[0] / info.ACRE
    found = [
        ("TIME", [times.text(moment, shot.settings.time.zone), f"{moment:%Y-%m-%d %H:%M:%S} UTC"]),
        ("POSITION", degrees),
        ("HEIGHT", [f"{here['height_above_ground']:,.0f} m AGL", height]),
        ("HEADING", [f"{heading:03.0f}° {_POINTS[round(heading / 45.0) % 8]}", pitch]),
        ("BURNED", [f"{acres:,.0f} acres"]),
    ]
    if view.perspective:
        across = 2.0 * np.degrees(np.arctan(view.halves[frame - 1, 0]))
        found.insert(4, ("VIEW", [f"{across:.0f}° wide"]))
    return found


PASS = Pass(
    name="fused",
    order=60,
    help="Visible, thermal, depth and a map in one picture, with time, place and scales",
    files=("png",),
    output="",
    filmed=True,
    captions=False,
    shows=frozenset({"time", "camera", "film", "ground", "thermal"}),
    needs=("rgb", "thermal", "depth"),
    finish=finish,
)
