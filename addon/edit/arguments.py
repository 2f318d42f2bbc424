"""Command line of `firetwin edit`, without imports that take time."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

DETAIL = """\
Writes film.otio, film.xml (Final Cut Pro 7 XML) and film.edl (CMX 3600) of the films of firetwin render.
Track V1 is a cut of the cameras in the order of the scene file; the tracks above have one camera each and
are disabled. Markers show ignition, flare-ups, and the fire's arrival at towns and stations. The EDL has only
V1."""


def add(parser: argparse.ArgumentParser, path: Callable[[str], Path], name: Callable[[str], str]) -> None:
    """Add the arguments after the scene; `path` and `name` are argument types."""
    parser.add_argument(
        "--out", metavar="DIR", type=path, required=True, help="folder to write, usually of firetwin render"
    )
    parser.add_argument("--film", metavar="DIR", type=path, help="folder of firetwin render, if another")
    parser.add_argument(
        "--pass", dest="name", metavar="NAME", type=name, default="rgb", help="pass of the films (rgb)"
    )
