"""`firetwin import`: cameras of other programs."""

from __future__ import annotations

import argparse

from .. import argument_types as types
from ..command import SCENES, Command

TIMES = ("own", "start", "shot")

_DETAIL = """\
Adds the cameras of FILE to SCENE.toml, whose comments and layout stay:
  .usd .usda .usdc .usdz   USD stages: perspective cameras, by frame number
  .abc                     Alembic: perspective cameras, by frame number
  .kml .kmz                Google Earth: tours (gx:Tour); without a tour the file becomes a flight track
  .gpx                     recorded flights, as the flight track of a drone

A USD stage or an Alembic file has the axes of the scene, unless it has a place on the Earth: --origin, a prim
CesiumGeoreference of the stage, or georeference.json next to the file. --times places the move in the film:
own (frame numbers, or UTC of a track; a tour starts with the film), start (from frame 1) or shot (over all
frames)."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument("file", metavar="FILE", type=types.path, help="file with cameras")
    parser.add_argument(
        "--out", metavar="SCENE.toml", type=types.path, required=True, help="scene file to change"
    )
    parser.add_argument(
        "--camera", metavar="NAME", type=types.name, help="only this camera of the file (all)"
    )
    parser.add_argument(
        "--name", metavar="NAME", type=types.name, help="name in the scene file (as in the file)"
    )
    parser.add_argument("--replace", action="store_true", help="replace cameras of equal names")
    parser.add_argument("--times", choices=TIMES, default=TIMES[0], help="place in the film (own)")
    parser.add_argument(
        "--origin",
        metavar="LAT,LON,HEIGHT",
        type=_origin,
        help="place of the origin of the file: degrees, and metres above the WGS84 ellipsoid",
    )
    parser.add_argument(
        "--geoid", metavar="M", type=types.undulation, help="height of the geoid above the WGS84 ellipsoid, m"
    )


def _origin(text: str) -> tuple[float, float, float]:
    """Convert to latitude, longitude and height."""
    try:
        latitude, longitude, height = map(float, text.split(","))
    except ValueError:
        latitude = longitude = height = float("nan")
    if not (abs(latitude) <= 90.0 and abs(longitude) <= 180.0 and abs(height) <= 1.0e7):
        raise argparse.ArgumentTypeError(f"must be degrees north, degrees east and metres, not {text!r}")
    return latitude, longitude, height


def _run(arguments: argparse.Namespace) -> None:
    """Add the cameras of a file to a scene file."""
    from ..shot.source import ShotSource
    from . import job

    job.run(arguments, ShotSource(scene=str(arguments.out)))


COMMAND = Command("import", "add cameras of USD, Alembic, KML and GPX files", _DETAIL, SCENES, _run, _add)
