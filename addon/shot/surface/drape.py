"""Orthophoto of a server (`terrain.photo_url`): pictures made of its tiles before a shot is built.

`jobs.tiles.imagery` fetches the tiles and writes the list of pictures that this module reads.
"""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from firetwin_core.run import Run

from ... import files
from ...errors import InputError, input_error
from ...tiles.imagery import address
from ...tiles.imagery.mercator import NORTHMOST
from ...tiles.sources import secret
from ..schema import scene_text
from ..settings import Settings
from ..view_digest import of_views

if TYPE_CHECKING:
    from ..shot import Shot


@dataclass(frozen=True)
class DrapeArea:
    """An area of the ground, and the picture of tiles that covers it.

    Attributes
    ----------
    low, high
        East and north of its corners in the scene, m.
    step
        Size of a texel on the ground, m.
    level, column, row, side
        Level of its tiles, column and row of the north-western one, and pixels along a tile.
    file
        Name of the picture, in Web Mercator, north up.
    """

    low: tuple[float, float]
    high: tuple[float, float]
    step: float
    level: int
    column: int
    row: int
    side: int
    file: str


@dataclass(frozen=True)
class Drape:
    """Pictures of a server's tiles for a shot: the picture of all ground first, then finer ones.

    Attributes
    ----------
    folder
        Folder of the pictures.
    credits
        Credits that pictures have to show.
    missing
        Tiles that could not be fetched, with reasons; coarser ones replace them.
    """

    folder: Path
    areas: tuple[DrapeArea, ...]
    credits: tuple[str, ...]
    missing: tuple[str, ...]


def check(settings: Settings, run: Run) -> None:
    """Check the address of an orthophoto without asking its server.

    Raises
    ------
    InputError
        Names the line of the scene file and what to do.
    """
    url = settings.terrain.photo_url
    if not url:
        return
    try:
        address.check(url)
    except InputError as error:
        raise key_error(settings, f"{error.path} {error.reason}") from None
    if min(abs(run.latitude.min()), abs(run.latitude.max())) > NORTHMOST:
        raise key_error(settings, f"tiles end at {NORTHMOST:.2f} degrees; name a GeoTIFF as terrain.photo")


def key_error(settings: Settings, reason: str) -> InputError:
    """Error of the key `terrain.photo_url`."""
    return scene_text.error_at(settings.path, ("terrain", "photo_url"), f"terrain.photo_url: {reason}")


def inputs(settings: Settings) -> dict[str, str]:
    """Return the address without secrets, on which colours depend."""
    url = settings.terrain.photo_url
    return {"photo url": secret.split(url)[0]} if url else {}


def location(shot: Shot) -> Path:
    """File of a shot's drape; it follows all that the drape depends on, except the server's pictures."""
    terrain, run = shot.settings.terrain, shot.run
    words = (
        secret.split(terrain.photo_url)[0],
        *map(repr, (terrain.photo_layer, terrain.photo_level, terrain.photo_size, terrain.photo_credit)),
        *map(repr, (terrain.near_radius, terrain.elevation, terrain.apron)),
        *(repr((float(axis[0]), float(axis[-1]))) for axis in (run.latitude, run.longitude)),
    )
    return shot.settings.cache / "drapes" / f"{of_views(shot, *words)}.json"


def write(drape: Drape, path: Path) -> None:
    """Write a drape next to its pictures."""
    about = {name: value for name, value in asdict(drape).items() if name != "folder"}
    files.write_text(path, json.dumps(about) + "\n")


def read(path: Path) -> Drape:
    """Read a drape.

    Raises
    ------
    InputError
        The file is damaged.
    """
    try:
        about: dict[str, Any] = files.read_json(path)
        areas = [_area(**each) for each in about["areas"]]
        lists = {name: tuple(map(str, about[name])) for name in ("credits", "missing")}
        return Drape(path.parent, tuple(areas), **lists)
    except (OSError, ValueError, LookupError, TypeError) as error:
        raise input_error(path, f"not a list of an orthophoto's pictures ({error}); delete it") from None


def _area(low: list[float], high: list[float], **others: Any) -> DrapeArea:
    (west, south), (east, north) = low, high
    return DrapeArea((float(west), float(south)), (float(east), float(north)), **others)


def of_shot(shot: Shot) -> Drape:
    """Read the drape of a shot with `terrain.photo_url`.

    Raises
    ------
    InputError
        It was not prepared.
    """
    path = location(shot)
    if not path.is_file():
        raise input_error(path, "the orthophoto of this shot was not fetched; build it again")
    return read(path)
