"""`firetwin cache`: cached smoke volumes and tiles."""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from .. import argument_types as types
from ..command import MACHINE, Command
from ..progress import count, duration, result, say, size

if TYPE_CHECKING:
    from ..jobs.cache import Cached


_DETAIL = """\
Lists volumes and tiles of each shot with size and last use, most recent first, and then cached responses of
tile servers. --prune removes the least recently used until volumes and tiles fit into --limit, and responses
into --answers. Files in use by a bake or render are not removed."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument(
        "places",
        metavar="SCENE|DIR",
        nargs="*",
        type=types.path,
        help="scene files or cache folders (./cache)",
    )
    parser.add_argument("--prune", action="store_true", help="remove the least recently used")
    parser.add_argument(
        "--limit",
        metavar="SIZE",
        type=types.size,
        default=types.size("20GB"),
        help="size of the cache after --prune, such as 500MB (20GB)",
    )
    parser.add_argument(
        "--answers",
        metavar="SIZE",
        type=types.size,
        default=types.size("4GB"),
        help="size of cached tile server responses after --prune (4GB)",
    )
    parser.add_argument(
        "--dry-run", action="store_true", help="list what --prune would remove; remove nothing"
    )


def _run(arguments: argparse.Namespace) -> None:
    """List cached smoke volumes and tiles, or remove the least recently used."""
    from ..jobs import cache

    folders = cache.folders(arguments.places or [Path("cache")])
    kept = cache.by_last_use(folders)
    where = " and ".join(map(str, folders))
    folder, number, total, used = cache.answers()
    if not arguments.prune:
        _list_cached(kept)
        if number:
            ago = duration(time.time() - used)
            result(f"{folder}  {size(total)}  {count(number, 'response')}, used {ago} ago")
        say(f"{size(sum(each.bytes for each in kept))} of {_name_content(kept)} in {where}")
        return
    gone = cache.prune(kept, arguments.limit, arguments.dry_run)
    _list_cached(gone)
    freed = sum(each.bytes for each in gone)
    left = sum(each.bytes for each in kept) - freed
    word = "would free" if arguments.dry_run else "freed"
    say(f"{word} {size(freed)}; {size(left)} of {_name_content(kept)} remain in {where}")
    if number:
        left = cache.prune_answers(arguments.answers, arguments.dry_run)
        say(f"{word} {size(total - left)}; {size(left)} of tile server responses remain in {folder}")


def _name_content(kept: Iterable[Cached]) -> str:
    """Name the content of a cache."""
    from ..jobs.tiles.cache import CachedTiles

    has_tiles = any(isinstance(each, CachedTiles) for each in kept)
    return "smoke volumes and tiles" if has_tiles else "smoke volumes"


def _list_cached(kept: Iterable[Cached]) -> None:
    for each in kept:
        ago = "in use" if each.in_use else f"used {duration(time.time() - each.used)} ago"
        result(f"{each.folder}  {size(each.bytes)}  {ago}")


COMMAND = Command(
    "cache",
    "list cached smoke volumes and tiles, or remove the least recently used",
    _DETAIL,
    MACHINE,
    _run,
    _add,
)
