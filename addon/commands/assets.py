"""`firetwin assets`: the asset library."""

from __future__ import annotations

import argparse
from pathlib import Path

from .. import argument_types as types
from ..command import SCENES, Command, add_overwrite
from ..progress import Reporter, count, result, say

_DETAIL = """\
Writes DIR/firetwin_assets.blend and DIR/blender_assets.cats.txt for Blender's asset browser. Add DIR under
Edit > Preferences > File Paths > Asset Libraries. Light, haze and temperatures are taken from the scene
file."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument(
        "scene", metavar="SCENE.toml", nargs="?", type=types.path, help="scene file (sample run)"
    )
    parser.add_argument("--out", metavar="DIR", type=types.path, required=True, help="folder of the library")
    add_overwrite(parser)


def _run(arguments: argparse.Namespace) -> None:
    """Write the asset library."""
    import tempfile

    from ..jobs import assets
    from ..shot.source import ShotSource

    with tempfile.TemporaryDirectory() as folder:
        scene = arguments.scene
        if scene is None:
            from ..data import sample

            say("writing a small sample run, which the assets are made for")
            sample.write(Path(folder) / "sample", 13)
            scene = Path(folder) / "scene.toml"
            scene.write_text(assets.SCENE, encoding="utf-8", newline="\n")
        source = ShotSource(scene=str(scene))
        number = assets.run(source, arguments.out, Reporter(), say, overwrite=arguments.overwrite)
    say(f"{count(number, 'asset')} in {arguments.out}")
    result(arguments.out / assets.BLEND)


COMMAND = Command(
    "assets",
    "write an asset library of trees, materials and node groups",
    _DETAIL,
    SCENES,
    _run,
    _add,
)
