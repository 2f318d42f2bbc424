"""The tiles that a shot shows: chosen once for all cameras and frames, and decoded to files."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import files
from ..errors import input_error

if TYPE_CHECKING:
    from .settings.protocols import ShotView


HEIGHTS = ".npz"
"""End of the file of a cut's heights (see `terrain.tile_heights`), which else has the cut's name."""


@dataclass(frozen=True)
class TileCut:
    """One cut through the trees of all sources.

    Attributes
    ----------
    folder, name
        Folder of the decoded tiles and their pictures, and the cut's own name in it.
    tiles
        Names of the decoded tiles' files; a tile's name follows its content and its place in the scene.
    credits
        Copyright notices of all tiles, those of most tiles first.
    missing
        What could not be had, and is shown by its ancestor.
    error
        Largest screen-space error that was allowed, pixels, after budgets.
    """

    folder: Path
    name: str
    tiles: tuple[str, ...]
    credits: tuple[str, ...]
    missing: tuple[str, ...]
    error: float


def write(cut: TileCut, path: Path) -> None:
    """Write a cut beside the files that it names."""
    about = {name: value for name, value in asdict(cut).items() if name not in ("folder", "name")}
    files.write_text(path, json.dumps(about) + "\n")


def read(path: Path) -> TileCut:
    """Read a cut.

    Raises
    ------
    InputError
        The file is damaged.
    """
    try:
        about: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        lists = {name: tuple(map(str, about[name])) for name in ("tiles", "credits", "missing")}
        return TileCut(path.parent, path.stem, error=float(about["error"]), **lists)
    except (OSError, ValueError, LookupError, TypeError) as error:
        raise input_error(path, 0, 0, f"is no list of chosen tiles ({error}); delete it") from None


def location(shot: ShotView) -> Path:
    """File of a shot's cut; it follows all that the choice depends on, except the tilesets themselves."""
    shot = shot.full
    settings = shot.settings.tiles
    digest = hashlib.sha256(repr(settings).encode() + repr(shot.ground.frame.latitude).encode())
    for path in shot.paths:
        for array in (path.position, path.rotation, path.halves, np.asarray([path.width, path.meet])):
            digest.update(np.ascontiguousarray(array, np.float64).tobytes())
        digest.update(np.ascontiguousarray(shot.filmed(path), np.int64).tobytes())
    return shot.settings.cache / "tiles" / f"{digest.hexdigest()[:16]}.json"


def of_shot(shot: ShotView) -> TileCut | None:
    """The cut of a shot; None where it has no tiles.

    Raises
    ------
    InputError
        It was not prepared.
    """
    if not shot.settings.tiles.sources:
        return None
    path = location(shot)
    if not path.is_file():
        raise input_error(path, 0, 0, "the tiles of this shot were not prepared; build it again")
    return read(path)
