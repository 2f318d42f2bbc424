"""Access to tiles, of every command that reads them."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..jobs.tiles.access import TileAccess


def add(parser: argparse.ArgumentParser) -> None:
    """Add the options."""
    parser.add_argument("--strict", action="store_true", help="fail if a tile is missing")
    parser.add_argument(
        "--offline", action="store_true", help="use only cached tiles and files on this machine"
    )
    parser.add_argument(
        "--host",
        metavar="HOST",
        action="append",
        default=[],
        help="additional host that files of a tileset may be on",
    )
    parser.add_argument(
        "--private", action="store_true", help="allow tilesets at addresses of private networks"
    )
    parser.add_argument(
        "--tile-root",
        metavar="DIR",
        default="",
        help="folder within which files of local tilesets may refer to ../FILE (root under [tiles])",
    )


def read(arguments: argparse.Namespace) -> TileAccess:
    """Collect the options."""
    from ..jobs.tiles.access import TileAccess

    return TileAccess(
        strict=arguments.strict,
        online=not arguments.offline,
        hosts=tuple(arguments.host),
        private=arguments.private,
        root=arguments.tile_root,
    )
