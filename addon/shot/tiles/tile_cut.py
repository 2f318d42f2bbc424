"""Tiles of a shot: selected once for all cameras and frames, and decoded to files."""

from __future__ import annotations

import functools
import json
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from ... import files
from ...errors import input_error
from ...imaging.credits import Credits
from .. import comparison, passes
from ..settings import mount
from ..shot import Shot, cached_on_shot
from ..terrain import tile_heights
from ..terrain.tile_heights import TileHeights
from ..view_digest import of_views

Finder = Callable[[str], "TileCut | None"]


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
        Copyright notices of all tiles, the most frequent first.
    missing
        Tiles that could not be fetched; their ancestors replace them.
    error
        Largest screen-space error that was allowed, pixels, after budgets.
    logo
        Names of services, which stand apart from the credits.
    empty
        How many of the tiles have no triangles.
    difference
        5th, 50th and 95th percentile of the tiles' ground above the scene's own, m; None if they never meet.
    bytes, triangles
        Totals of all tiles: bytes that were fetched, and triangles that are shown.
    """

    folder: Path
    name: str
    tiles: tuple[str, ...]
    credits: tuple[str, ...]
    missing: tuple[str, ...]
    error: float
    logo: tuple[str, ...] = ()
    empty: int = 0
    difference: tuple[float, float, float] | None = None
    bytes: int = 0
    triangles: int = 0

    @property
    def words(self) -> Credits:
        """Credits that pictures have to show."""
        return Credits(self.credits, self.logo)

    def is_whole(self) -> bool:
        """Return whether all its files exist, and no tile was missing when it was selected."""
        there = all((self.folder / name).is_file() for name in self.tiles)
        heights = heights_file(self.folder / self.name)
        return there and not self.missing and (heights.is_file() or not self.tiles)


def heights_file(path: Path) -> Path:
    """Return the file of the heights of a cut (see `terrain.tile_heights`), by the file of the cut."""
    return path.with_suffix(".npz")


def write(cut: TileCut, path: Path) -> None:
    """Write a cut next to the files that it names."""
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
        about: dict[str, Any] = files.read_json(path)
        tiles, credits, missing, logo = (
            tuple(map(str, about[name])) for name in ("tiles", "credits", "missing", "logo")
        )
        difference = about["difference"] and tuple(map(float, about["difference"]))
        found = TileCut(path.parent, path.stem, tiles, credits, missing, float(about["error"]), logo)
        empty, size, triangles = (int(about[name]) for name in ("empty", "bytes", "triangles"))
        return replace(found, empty=empty, bytes=size, triangles=triangles, difference=difference)
    except (OSError, ValueError, LookupError, TypeError) as error:
        raise input_error(path, f"not a list of selected tiles ({error}); delete it") from None


@cached_on_shot
def location(shot: Shot) -> Path:
    """File of a shot's cut; it follows all that the choice depends on, except the tilesets themselves."""
    settings = shot.full.settings
    return settings.cache / "tiles" / f"{of_views(shot, '2', repr(settings.tiles))}.json"


def prepared(shot: Shot) -> TileCut | None:
    """Read the cut of a shot; None without tiles, and before they are prepared."""
    if not shot.settings.tiles.sources:
        return None
    path = location(shot)
    return read(path) if path.is_file() else None


def of_shot(shot: Shot) -> TileCut | None:
    """Read the cut of a shot; None without tiles.

    Raises
    ------
    InputError
        It was not prepared.
    """
    found = prepared(shot)
    if found is None and shot.settings.tiles.sources:
        raise input_error(location(shot), "the tiles of this shot were not prepared; build it again")
    return found


def finder(shot: Shot) -> Finder:
    """Make a function that finds the cut of a view of a shot, or None; it looks each view up once."""
    return functools.cache(lambda view: prepared(comparison.for_view(shot, view)))


def of_pass(shot: Shot, view: str, name: str, find: Finder) -> list[TileCut]:
    """Find the prepared cuts that a view's pictures in a pass show.

    These are the cuts of the view, of cameras on its mount, and for a comparison of all runs.
    """
    if not shot.settings.tiles.sources:
        return []
    camera, _, label = view.partition("@")
    taken = mount.taken(shot.settings, shot.cameras, camera, passes.known()[name]).values()
    cameras = dict.fromkeys((camera, *(other for other, _ in taken)))
    labels = ("", *shot.others) if passes.compares(name) else (label,)
    views = [passes.view_of(each, run) if run else each for each in cameras for run in labels]
    return [cut for each in views if (cut := find(each)) is not None]


def heights(shot: Shot) -> TileHeights | None:
    """Read the heights of a shot's tiles; None without tiles, and before they are prepared."""
    if not shot.settings.tiles.sources or not heights_file(location(shot)).is_file():
        return None
    return _read_heights(shot)


@cached_on_shot
def _read_heights(shot: Shot) -> TileHeights:
    return tile_heights.read(heights_file(location(shot)), shot.run)
