"""`firetwin new`: a scene file that fits a run."""

from __future__ import annotations

import argparse

from .. import argument_types as types
from ..command import SCENES, Command, add_overwrite
from ..progress import result

_DETAIL = """\
Selects the most active part of the run, and fits cameras to the fire: an overview from upwind with the sun
behind it, a chase camera at the head, a close view of a flank, and a view from above. Each camera is moved
until at least half of its front is in the frustum and not occluded by terrain or dense smoke; the visible
share is printed. `render`, `build` and `bake` of RUN use the same settings."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument("run", metavar="RUN", type=types.path, help="run folder")
    parser.add_argument(
        "-o", "--out", metavar="SCENE.toml", type=types.path, required=True, help="file to write"
    )
    for name, word in (("start", "first"), ("end", "last")):
        text = f"model time of the {word} frame, such as 2014-09-17T16:00-07:00 (fitted)"
        parser.add_argument(f"--{name}", metavar="TIME", type=types.moment, help=text)
    add_overwrite(parser)


def _run(arguments: argparse.Namespace) -> None:
    """Write a scene file that fits a run."""
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


COMMAND = Command("new", "write a short scene file that fits a run", _DETAIL, SCENES, _run, _add)
