"""`firetwin new`: a scene file that fits a run, or scene files that show its kinds of fire."""

from __future__ import annotations

import argparse
from pathlib import Path

from .. import argument_types as types
from ..command import SCENES, Command, add_overwrite
from ..progress import result

_DETAIL = """\
Selects the most active part of the run, by daylight if it is nearly as active, and fits cameras to the fire:
an overview from upwind with the sun behind it, a chase camera at the head, a close view of a flank, and a
view from above. Each camera is moved until at least half of its front is in the frustum and not occluded by
terrain or dense smoke; the visible share is printed. `render`, `build` and `bake` of RUN use
the same settings.

--views writes one scene file for each kind of fire in the run, by day and by night: a torching crown, surface
fire under trees, grass fire, and a crown run. Each is a clip of four seconds in real time, from distances of
5 m to 2 km. Cameras are on unburned ground to windward, and no tree or hill is before the flames."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument("run", metavar="RUN", type=types.path, help="run folder")
    target = parser.add_mutually_exclusive_group(required=True)
    target.add_argument("-o", "--out", metavar="SCENE.toml", type=types.path, help="file to write")
    target.add_argument(
        "--views",
        metavar="DIR",
        type=types.path,
        nargs="?",
        const=Path("views"),
        help="folder for scene files of each kind of fire (views)",
    )
    for name, word in (("start", "first"), ("end", "last")):
        text = f"model time of the {word} frame, such as 2014-09-17T16:00-07:00 (fitted)"
        parser.add_argument(f"--{name}", metavar="TIME", type=types.moment, help=text)
    add_overwrite(parser)


def _run(arguments: argparse.Namespace) -> None:
    """Write a scene file that fits a run, or the views of its fire."""
    if arguments.views is not None:
        _write_views(arguments)
        return
    from .. import output
    from ..auto_framing import fitted_scene
    from ..errors import UsageError

    if arguments.out.suffix != ".toml":
        raise UsageError(f"-o: {arguments.out} does not end in .toml; name a .toml file")
    output.check(arguments.out, arguments.overwrite)
    asked = arguments.start, arguments.end
    text = fitted_scene.fit_text(arguments.run, arguments.out, arguments.out.parent / "cache", asked)
    output.write_text(arguments.out, text, arguments.overwrite)
    result(arguments.out)


def _write_views(arguments: argparse.Namespace) -> None:
    """Write scene files that show each kind of fire."""
    from .. import output
    from ..auto_framing import fire_views
    from ..progress import say

    folder, asked = arguments.views, (arguments.start, arguments.end)
    for name in fire_views.names():
        output.check(folder / name, arguments.overwrite)
    cache = arguments.run.parent / "cache"
    for view in fire_views.find_views(arguments.run, folder, cache, asked):
        say(view.words)
        if view.text:
            output.write_text(folder / view.name, view.text, arguments.overwrite)
            result(folder / view.name)


COMMAND = Command("new", "write short scene files that fit a run", _DETAIL, SCENES, _run, _add)
