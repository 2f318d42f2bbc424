"""Command line of `firetwin export`, without imports that take time."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

from .formats import known

_DETAIL = """\
Writes a scene for other programs, with its place on the Earth in DIR/georeference.json. Formats:
{formats}
Heights of a run above sea level become heights above the WGS84 ellipsoid by the height of the geoid: --geoid,
[tiles] geoid of the scene file, or EGM96 from a grid of this machine. Existing files with the same names are
replaced after all new files are complete."""

DETAIL = _DETAIL.format(formats="\n".join(f"  {name:<6}{each.help}" for name, each in known().items()))


def add(
    parser: argparse.ArgumentParser, path: Callable[[str], Path], undulation: Callable[[str], float]
) -> None:
    """Add the arguments after the scene; `path` and `undulation` are argument types."""
    parser.add_argument("--to", choices=tuple(known()), required=True, help="format")
    parser.add_argument("--out", metavar="DIR", type=path, required=True, help="folder to write")
    parser.add_argument("--frames", metavar="LIST", help="frames, such as 1-10, 3,5-9 or 1-48:4 (all)")
    parser.add_argument(
        "--geoid", metavar="M", type=undulation, help="height of the geoid above the WGS84 ellipsoid, m"
    )
    parser.add_argument("--no-smoke", action="store_true", help="omit the smoke volumes (usd)")
