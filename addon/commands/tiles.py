"""`firetwin tiles`: tilesets, read and made."""

from __future__ import annotations

import argparse

from .. import argument_types as types
from ..command import SCENES, Command, add_overwrite, add_scene, add_verb
from . import _tile_access

_DETAIL = """\
  firetwin tiles info SOURCE             levels, contents, errors, extent and credits of a tileset
  firetwin tiles make SCENE --out DIR    3D Tiles 1.1 of a scene's ground and of buildings

SOURCE is a tileset.json, its folder, a .3tz archive, a URL, or an asset of Cesium ion such as ion:96188. Keys
of services are read from the environment: GOOGLE_MAPS_API_KEY, CESIUM_ION_TOKEN."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the verbs."""
    verbs = parser.add_subparsers(dest="verb", metavar="VERB", required=True)
    info = add_verb(verbs, "info", "list the content of a tileset")
    info.add_argument("source", metavar="SOURCE", help="tileset.json, folder, .3tz archive, URL or ion:ASSET")
    info.add_argument("--json", action="store_true", help="write JSON")
    info.add_argument(
        "--files",
        metavar="N",
        type=types.count,
        help="maximum JSON files and subtrees to read (default: all; 50 of a server, 1 if it forbids more)",
    )
    _tile_access.add(info)
    make = add_verb(verbs, "make", "make a tileset of a scene's ground and of buildings")
    add_scene(make)
    make.add_argument("--out", metavar="DIR", type=types.path, required=True, help="folder of the tileset")
    make.add_argument(
        "--levels", metavar="N", type=types.count, help="depth of the quadtree (as the heights need)"
    )
    make.add_argument(
        "--buildings", metavar="FILE", type=types.path, help="footprints: GeoJSON, GeoPackage or shapefile"
    )
    make.add_argument(
        "--geoid",
        metavar="M",
        type=float,
        help="height of the geoid above the WGS84 ellipsoid, m (default: EGM96, by a grid of this machine)",
    )
    text = "credit of the data (default: run and orthophoto)"
    make.add_argument("--credit", metavar="TEXT", default="", help=text)
    add_overwrite(make)


def _run(arguments: argparse.Namespace) -> None:
    """Read a tileset, or make one."""
    if arguments.verb == "make":
        _make(arguments)
        return
    from ..jobs.tiles.access import apply_preferences
    from ..tiles import list_command

    list_command.run(arguments, apply_preferences(_tile_access.read(arguments)).network())


def _make(arguments: argparse.Namespace) -> None:
    """Make a tileset of a scene."""
    from ..auto_framing import fitted_scene
    from ..jobs.tiles import imagery, make
    from ..progress import Reporter, count, result, say, size

    request = make.TilesRequest(
        arguments.out,
        arguments.levels,
        arguments.buildings,
        arguments.geoid,
        arguments.credit,
        arguments.overwrite,
    )
    choice, reporter = fitted_scene.find_source(arguments), Reporter("tiles")
    imagery.prepare(choice, (), reporter, say)
    made = make.run(choice.shot(), request, reporter, say)
    errors = ", ".join(f"{error:.3g}" for error in made.errors)
    buildings = f" with {count(made.buildings, 'building')}" if made.buildings else ""
    say(f"{count(made.tiles, 'tile')}{buildings}, {size(made.bytes)}; errors of the levels: {errors} m")
    result(arguments.out / "tileset.json")


COMMAND = Command("tiles", "read and make 3D tilesets", _DETAIL, SCENES, _run, _add)
