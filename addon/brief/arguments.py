"""Command line of `firetwin brief`, without imports that take time."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from datetime import datetime
from pathlib import Path

LIMIT = 32_000_000  # bytes
PAPERS = ("a4", "a3", "letter", "tabloid")

DETAIL = """\
Writes one HTML file that opens without a network connection. It has a map with hill shading, fuel and
arrival time, fire fronts with a time slider, arrival times at stations and places, burned area compared with
reports, pictures and clips of a film, scores against observations, and all sources and licences. The page
loads no other files. Invented rows of FILE.gpkg are marked "exercise" in the page."""


def add(
    parser: argparse.ArgumentParser,
    path: Callable[[str], Path],
    size: Callable[[str], int],
    name: Callable[[str], str],
    moment: Callable[[str], datetime],
) -> None:
    """Add the arguments; `path`, `size`, `name` and `moment` are argument types."""
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
        "--ensemble",
        metavar="DIR",
        type=path,
        help="ensemble of the forecast (none)",
    )
    parser.add_argument(
        "--limit",
        metavar="SIZE",
        type=size,
        default=LIMIT,
        help="maximum size of the page, such as 8MB (32MB)",
    )
    parser.add_argument(
        "--context",
        metavar="NAME=FILE",
        action="append",
        type=name,
        default=[],
        help="map features: roads, water, boundaries, zones, values or another name; repeatable (none)",
    )
    parser.add_argument(
        "--pdf", metavar="X.pdf", type=path, help="also print the page, by Chromium or WeasyPrint (none)"
    )
    parser.add_argument(
        "--geopdf",
        metavar="X.pdf",
        type=path,
        help="also write the map sheet with coordinates, by GDAL (none)",
    )
    _add_sheet(parser, name, moment)


def _add_sheet(
    parser: argparse.ArgumentParser, name: Callable[[str], str], moment: Callable[[str], datetime]
) -> None:
    """Add the choices for the printed sheets."""
    sheet = parser.add_argument_group("printed sheets")
    sheet.add_argument("--paper", choices=PAPERS, default="a4", help="paper; tabloid is 11 x 17 in (a4)")
    sheet.add_argument(
        "--orientation", choices=("portrait", "landscape"), help="orientation (the one with the larger map)"
    )
    sheet.add_argument(
        "--grid", choices=("latlong", "usng", "none"), default="latlong", help="grid of the map (latlong)"
    )
    sheet.add_argument("--units", choices=("us", "metric"), default="us", help="units of the map (us)")
    sheet.add_argument("--incident", metavar="TEXT", type=name, help="name of the incident (name of the run)")
    sheet.add_argument("--author", metavar="TEXT", type=name, help="author of the map (not stated)")
    sheet.add_argument(
        "--period",
        metavar="TIME",
        nargs=2,
        type=moment,
        help="first and last time of the operational period, 2014-09-17T06:00-07:00 (time of the run)",
    )
    sheet.add_argument("--prepared", metavar="TIME", type=moment, help="time of preparation (now)")
    sheet.add_argument(
        "--issued", metavar="TIME", type=moment, help="issue time of the model's output (start of the run)"
    )
