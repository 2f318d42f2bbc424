"""`firetwin bake`: smoke for `render`, or smoke volumes."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from ..command import FILMS, Command, add_scene
from ..progress import Reporter, result, say

if TYPE_CHECKING:
    from ..shot.source import ShotSource


_DETAIL = """\
Without --volumes, `bake` does the work on smoke that `render` otherwise does: it solves the flow, or writes
the volumes of smoke that Blender draws. With --volumes it writes the volumes that a .blend file of `build`
shows; the file itself does not change."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    add_scene(parser)
    parser.add_argument(
        "--volumes", action="store_true", help="write the smoke volumes that a .blend file of build shows"
    )
    parser.add_argument(
        "--frames", metavar="LIST", help="frames of these volumes, such as 1-10 (all that cameras film)"
    )


def _run(arguments: argparse.Namespace) -> None:
    """Prepare smoke for `render`, or write smoke volumes."""
    from ..auto_framing import fitted_scene
    from ..errors import UsageError
    from ..jobs import bake

    source, frames = fitted_scene.find_source(arguments), None
    if arguments.frames is not None:
        if not arguments.volumes:
            raise UsageError("--frames: selects volumes; add --volumes")
        frames = _frames(arguments.frames, source)
    folders = bake.run(source, Reporter("smoke"), say, volumes=arguments.volumes, frames=frames)
    if not folders:
        say("nothing to bake: this scene has no smoke ([smoke] enabled = false)")
    for folder in folders:
        result(folder)


def _frames(text: str, source: ShotSource) -> list[int]:
    """Read a list of frames of a shot."""
    from ..errors import UsageError
    from ..shot.schema.frame_list import FrameList

    try:
        return FrameList(text).frames(source.settings().time.frames)
    except ValueError as error:
        raise UsageError(f"--frames: {error}") from None


COMMAND = Command("bake", "prepare smoke for render, or write smoke volumes", _DETAIL, FILMS, _run, _add)
