"""Decoded tiles in a scene's cache: the selection of each shot with its files, and unused files.

Selections share files. A file counts for the selection used last, and is removed with the last selection that
names it.
"""

from __future__ import annotations

import contextlib
import os
import re
import time
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from ...errors import InputError
from ...shot.tiles import tile_cut
from ...smoke.cache import IN_USE
from ...tiles import decoded

FOLDER = "tiles"
_CUT = re.compile(r"[0-9a-f]{16}")
_OURS = re.compile(
    r"[0-9a-f]{32}\.(tile|jpg|png|webp)|content/[0-9a-f]{64}|heights-[0-9a-f]{16}\.npz|[0-9a-f]{16}\.(npz|json)"
    r"|[0-9a-f]{16}/\d+\.\d{4}\.(jpg|png|webp)"
)


@dataclass(frozen=True)
class CachedTiles:
    """Tiles of one selection, or files of no selection.

    Attributes
    ----------
    folder
        File of the selection; the folder of tiles for the rest.
    bytes
        Bytes on the disk, without files that a later selection names.
    used
        Time of last use, s since 1970.
    names
        Files, relative to the folder of tiles.
    """

    folder: Path
    bytes: int
    used: float
    names: frozenset[str]

    @property
    def in_use(self) -> bool:
        """True if a render may be using them."""
        return time.time() - self.used < IN_USE


def list_tiles(cache: Path) -> list[CachedTiles]:
    """List tiles in a cache, most recently used first. Foreign files are ignored."""
    place = cache / FOLDER
    files = _files(place)
    cuts = {path: _names(path, files) for path in place.glob("*.json") if _CUT.fullmatch(path.stem)}
    listed, seen = [], set[tuple[int, int]]()
    used = {path: path.stat().st_mtime for path in cuts}
    for path in sorted(cuts, key=lambda each: -used[each]):
        listed.append(CachedTiles(path, _size(cuts[path], files, seen), used[path], cuts[path]))
    if rest := frozenset(files).difference(*cuts.values()):
        last = max(files[name].st_mtime for name in rest)
        listed.append(CachedTiles(place, _size(rest, files, seen), last, rest))
    return listed


def remove(tiles: CachedTiles) -> bool:
    """Remove tiles that are not in use and that no other selection names."""
    place = tiles.folder if tiles.folder.name == FOLDER else tiles.folder.parent
    files = _files(place)
    own = tiles.folder if tiles.folder.is_file() else None
    if own is not None and time.time() - own.stat().st_mtime < IN_USE:
        return False
    others = (path for path in place.glob("*.json") if _CUT.fullmatch(path.stem) and path != own)
    kept = frozenset().union(*(_names(path, files) for path in others))
    if own is not None:  # first, so that no render uses a selection whose files are being removed
        own.unlink(missing_ok=True)
    for name in tiles.names - kept:
        with contextlib.suppress(OSError):
            (place / name).unlink(missing_ok=True)
    for folder in (tiles.folder.with_suffix(""), place / "content", place):
        with contextlib.suppress(OSError):
            folder.rmdir()
    return True


def _files(place: Path) -> dict[str, os.stat_result]:
    """List Firetwin's files in a folder of tiles."""
    stats = {}
    for path in place.rglob("*") if place.is_dir() else ():
        name = path.relative_to(place).as_posix()
        if _OURS.fullmatch(name) and not path.is_symlink():
            with contextlib.suppress(OSError):
                stats[name] = path.stat()
    return stats


def _names(path: Path, files: Iterable[str]) -> frozenset[str]:
    """List the files of a selection: its own, decoded tiles, and their pictures."""
    own = {name for name in files if name.split("/")[0].split(".")[0] == path.stem}
    try:
        cut = tile_cut.read(path)
    except InputError:  # damaged, or gone
        return frozenset(own)
    pictures = (name for tile in cut.tiles for name in decoded.picture_names(path.parent / tile))
    return frozenset({*own, *cut.tiles, *pictures})


def _size(names: Iterable[str], files: dict[str, os.stat_result], seen: set[tuple[int, int]]) -> int:
    """Sum the bytes of files that were not counted yet; hard links count once."""
    total = 0
    for name in names:
        if (about := files.get(name)) is not None and (key := (about.st_dev, about.st_ino)) not in seen:
            seen.add(key)
            total += about.st_size
    return total
