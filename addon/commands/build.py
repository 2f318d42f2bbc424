"""`firetwin build`: the scene as a .blend file."""

from __future__ import annotations

import argparse

from .. import argument_types as types
from ..command import SCENES, Command, add_scene
from ..progress import Reporter, result, say
from . import _tile_access

_DETAIL = """\
The file can be opened, played and rendered without the add-on. Its smoke volumes are files in the cache
folder, about 50 MB per frame of the example. Without --volumes they are written later: by the add-on for
the frames that you choose, by the add-on before a frame is rendered in Blender, or by `bake --volumes`. A
frame without volumes says so in the picture. `render` does not need them.

--live adds the same shot in a form that 3D views and headsets draw fast, and shows it there. Renders always
show the film's scene. The collection "Firetwin Live" has the live scene."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    add_scene(parser)
    parser.add_argument(
        "-o", "--out", metavar="X.blend", type=types.path, required=True, help="file to write"
    )
    parser.add_argument(
        "--run", metavar="NAME", type=types.name, help="name of the run of [[runs]] (the first run)"
    )
    parser.add_argument(
        "--volumes", action="store_true", help="also write the smoke volumes of all frames, for a farm"
    )
    parser.add_argument(
        "--live",
        action="store_true",
        help="also build the live scene, for headsets, and show it",
    )
    _tile_access.add(parser)


def _run(arguments: argparse.Namespace) -> None:
    """Build the scene and save it."""
    from ..auto_framing import fitted_scene
    from ..errors import UsageError
    from ..jobs import build

    if arguments.out.suffix != ".blend":
        raise UsageError(f"-o: {arguments.out} does not end in .blend; name a .blend file")
    access, source = _tile_access.read(arguments), fitted_scene.find_source(arguments)
    build.run(
        source,
        arguments.out,
        Reporter(),
        say,
        access=access,
        volumes=arguments.volumes,
        live=arguments.live,
    )
    result(arguments.out)


COMMAND = Command("build", "build the scene and save it as a .blend file", _DETAIL, SCENES, _run, _add)
