"""Command line of `firetwin brief`, without imports that take time."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

LIMIT = 32_000_000  # bytes

DETAIL = """\
Writes one HTML file that opens without a network connection. It has a map with hill shading, fuel and
arrival time, fire fronts with a time slider, arrival times at stations and places, burned area compared with
reports, pictures and clips of a film, scores against observations, and all sources and licences. The page
loads no other files. Invented rows of FILE.gpkg are marked "exercise" in the page."""


def add(parser: argparse.ArgumentParser, path: Callable[[str], Path], size: Callable[[str], int]) -> None:
    """Add the arguments; `path` and `size` are argument types."""
    parser.add_argument("scene", metavar="SCENE|RUN", type=path, help="scene file, or run folder")
    parser.add_argument("--out", metavar="X.html", type=path, required=True, help="file to write")
    parser.add_argument(
        "--stations", metavar="FILE.gpkg", type=path, help="GeoPackage of stations and resources (none)"
    )
    parser.add_argument(
        "--film", metavar="DIR", type=path, help="folder of firetwin render, for pictures and clips (none)"
    )
    parser.add_argument(
        "--against",
        metavar="FILE",
        nargs="+",
        default=[],
        help="observed perimeters and detections (RUN/observations)",
    )
    parser.add_argument(
        "--limit",
        metavar="SIZE",
        type=size,
        default=LIMIT,
        help="maximum size of the page, such as 8MB (32MB)",
    )
