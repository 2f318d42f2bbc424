"""Command line of `firetwin tiles`; imports only light modules."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

DETAIL = """\
  firetwin tiles info SOURCE             levels, contents, errors, extent and credits of a tileset
  firetwin tiles make SCENE --out DIR    3D Tiles 1.1 of a scene's ground and of buildings

SOURCE is a tileset.json, its folder, a .3tz archive, a URL, or an asset of Cesium ion such as ion:96188. Keys
of services are read from the environment: GOOGLE_MAPS_API_KEY, CESIUM_ION_TOKEN."""


def add(parser: argparse.ArgumentParser, path: Callable[[str], Path], count: Callable[[str], int]) -> None:
    """Define the verbs.

    Parameters
    ----------
    path, count
        Types of arguments.
    """
    verbs = parser.add_subparsers(dest="verb", metavar="VERB", required=True)
    summary = "list the content of a tileset"
    info = verbs.add_parser("info", help=summary, description=f"{summary[0].upper()}{summary[1:]}.")
    info.add_argument("--debug", action="store_true", help="show a traceback when something fails")
    info.add_argument("source", metavar="SOURCE", help="tileset.json, folder, .3tz archive, URL or ion:ASSET")
    info.add_argument("--json", action="store_true", help="write JSON")
    info.add_argument(
        "--files",
        metavar="N",
        type=count,
        help="maximum JSON files and subtrees to read (default: all; 50 of a server, 1 if it forbids more)",
    )
    add_access(info)
    summary = "make a tileset of a scene's ground and of buildings"
    make = verbs.add_parser("make", help=summary, description=f"{summary[0].upper()}{summary[1:]}.")
    make.add_argument("--debug", action="store_true", help="show a traceback when something fails")
    make.add_argument("scene", metavar="SCENE|RUN", type=path, help="scene file, or run folder")
    make.add_argument("--out", metavar="DIR", type=path, required=True, help="folder of the tileset")
    make.add_argument("--levels", metavar="N", type=count, help="depth of the quadtree (as the heights need)")
    make.add_argument(
        "--buildings", metavar="FILE", type=path, help="footprints: GeoJSON, GeoPackage or shapefile"
    )
    make.add_argument(
        "--geoid",
        metavar="M",
        type=float,
        help="height of the geoid above the WGS84 ellipsoid, m (default: EGM96, by a grid of this machine)",
    )
    text = "credit of the data (default: run and orthophoto)"
    make.add_argument("--credit", metavar="TEXT", default="", help=text)


def add_access(parser: argparse.ArgumentParser) -> None:
    """Define the options for access to tiles, for every command that reads them."""
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
