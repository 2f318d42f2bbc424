"""`firetwin render`: pictures and films."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import argument_types as types
from ..command import FILMS, Command, add_scene, amend
from ..progress import Reporter, count, result, say
from . import _tile_access

if TYPE_CHECKING:
    from ..jobs.render import RenderResult


_DETAIL = """\
DIR/CAMERA/PASS/CAMERA_PASS_000001.png   and .exr, by pass
DIR/CAMERA/CAMERA_PASS.mp4               films, with the model time in each frame
DIR/manifest.json                        settings, versions, hashes of inputs and files
DIR/first.png                            coarse picture with preview smoke, while the smoke
                                         of the first picture is solved

passes:
{passes}

Without --resume all selected frames are rendered again. Several renders, on one or more computers, can write
to one folder at the same time and divide the frames by leases. Start each with --resume and with the same
scene file, run, Firetwin and Blender.

Before the first frame the expected memory is printed, if there is an estimate: for smoke solved as a flow
and ray marched, and for pictures without smoke. At the end --json prints expected and peak memory (bytes,
null if unknown), the number of pictures rendered by this command, and the files."""


def _detail() -> str:
    """Describe the output, and each pass."""
    from ..shot import passes

    width = max(map(len, passes.helps()))
    lines = (f"  {name:<{width}} {text}" for name, text in passes.helps().items())
    return _DETAIL.format(passes="\n".join(lines))


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    add_scene(parser)
    parser.add_argument(
        "--out", metavar="DIR", type=types.path, required=True, help="folder for the pictures"
    )
    parser.add_argument(
        "--frames",
        metavar="LIST",
        help="frames of each camera, such as 1-10, 3,5-9 or 1-48:4 (all)",
    )
    parser.add_argument(
        "--camera",
        metavar="NAME",
        type=types.name,
        help="name of a camera (all); drone@RUN for one run",
    )
    parser.add_argument(
        "--passes", metavar="LIST", help="passes, such as rgb,thermal (passes of the scene file)"
    )
    parser.add_argument(
        "--resume",
        action="store_true",
        help="keep finished pictures whose settings and inputs have not changed",
    )
    parser.add_argument(
        "--preset",
        choices=types.OUTPUT_PRESETS,
        help="settings of EXR files and films for post-production (from the scene file)",
    )
    parser.add_argument("--json", action="store_true", help="write JSON: files and memory")
    _tile_access.add(parser)


def _run(arguments: argparse.Namespace) -> None:
    """Render the requested pictures that are not finished, then the films."""
    from ..auto_framing import fitted_scene
    from ..jobs import render

    asked = render.RenderRequest(
        arguments.out,
        arguments.frames,
        arguments.camera,
        arguments.passes,
        arguments.resume,
        access=_tile_access.read(arguments),
        coarse_first=True,
    )
    run = amend(arguments, render.run)
    made = run(fitted_scene.find_source(arguments), asked, Reporter(), say)
    if arguments.json:
        print(json.dumps(_render_json(arguments.out, made), indent=1))
    else:
        _list_output(arguments.out)


def _render_json(out: Path, made: RenderResult) -> dict[str, Any]:
    """Collect the result of a render for JSON; memory in bytes, None if unknown."""
    memory = {"expected": made.expected or None, "peak": made.peak or None}
    return {"folder": str(out), "pictures": made.pictures, "files": _finished_files(out), "memory": memory}


def _finished_files(out: Path) -> list[str]:
    """List the finished files, relative to the folder."""
    from ..render.store import Store

    with Store(out) as store:
        return store.names()


def _list_output(out: Path) -> None:
    """List the output: a line per folder of pictures and per film."""
    from ..render import manifest
    from ..render.picture import FILM_SUFFIXES

    files = _finished_files(out)
    folders: dict[str, int] = {}
    for name in files:
        if not name.endswith(FILM_SUFFIXES):
            kind = f"{Path(name).parent}/*{Path(name).suffix}"
            folders[kind] = folders.get(kind, 0) + 1
    for kind, number in folders.items():
        result(f"{out / kind}  {count(number, 'picture')}")
    for name in files:
        if name.endswith(FILM_SUFFIXES):
            result(out / name)
    result(out / manifest.NAME)


COMMAND = Command("render", "render pictures and films", _detail, FILMS, _run, _add)
