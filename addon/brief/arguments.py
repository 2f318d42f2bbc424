"""The command line of `firetwin brief`; nothing heavy is imported here."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

LIMIT = 32_000_000  # bytes

DETAIL = """\
Writes one HTML file that opens without a network: a map with hill shading, fuel and arrival time, fronts by
time with a slider, when the fire reaches stations and places, burned area beside reports, pictures and clips
of a film, scores against observations, and the sources and licences of everything. The page loads nothing
from elsewhere. Rows of FILE.gpkg that are invented say "exercise", and so does the page."""


def add(parser: argparse.ArgumentParser, path: Callable[[str], Path], size: Callable[[str], int]) -> None:
    """Add arguments; `path` and `size` parse theirs."""
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
        help="size of the page at most, such as 8MB (32MB)",
    )
