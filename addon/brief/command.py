"""`firetwin brief`: the briefing page of a run."""

from __future__ import annotations

import argparse
import re

from .. import argument_types as types
from ..command import RUNS, Command, add_overwrite, amend

LIMIT = 32_000_000  # bytes
PAPERS = ("a4", "a3", "letter", "tabloid")

_DETAIL = """\
Writes one HTML file that opens without a network connection. It has a map with hill shading, fuel and
arrival time, fire fronts with a time slider, arrival times at stations and places, burned area compared with
reports, pictures and clips of a film, scores against observations, and all sources and licences. The page
loads no other files. Invented rows of FILE.gpkg are marked "exercise" in the page."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument("scene", metavar="SCENE|RUN", type=types.path, help="scene file, or run folder")
    parser.add_argument("--out", metavar="X.html", type=types.path, required=True, help="file to write")
    parser.add_argument(
        "--stations", metavar="FILE.gpkg", type=types.path, help="GeoPackage of stations and resources (none)"
    )
    parser.add_argument(
        "--film",
        metavar="DIR",
        type=types.path,
        help="folder of firetwin render, for pictures and clips (none)",
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
        type=types.size,
        default=LIMIT,
        help="maximum size of the page, such as 8MB (32MB)",
    )
    parser.add_argument(
        "--context",
        metavar="NAME=FILE",
        action="append",
        type=types.name,
        default=[],
        help="map features: roads, water, boundaries, zones, values or another name; repeatable (none)",
    )
    parser.add_argument(
        "--pdf",
        metavar="X.pdf",
        type=types.path,
        help="also print the page, by Chromium or WeasyPrint (none)",
    )
    parser.add_argument(
        "--geopdf",
        metavar="X.pdf",
        type=types.path,
        help="also write the map sheet with coordinates, by GDAL (none)",
    )
    add_overwrite(parser)
    _add_sheet(parser)


def _add_sheet(parser: argparse.ArgumentParser) -> None:
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
    sheet.add_argument(
        "--incident", metavar="TEXT", type=types.name, help="name of the incident (name of the run)"
    )
    sheet.add_argument("--author", metavar="TEXT", type=types.name, help="author of the map (not stated)")
    sheet.add_argument(
        "--period",
        metavar="TIME",
        nargs=2,
        type=types.moment,
        help="first and last time of the operational period, 2014-09-17T06:00-07:00 (time of the run)",
    )
    sheet.add_argument("--prepared", metavar="TIME", type=types.moment, help="time of preparation (now)")
    sheet.add_argument(
        "--issued",
        metavar="TIME",
        type=types.moment,
        help="issue time of the model's output (start of the run)",
    )


def _rename_places(words: list[str]) -> tuple[list[str], list[str]]:
    """Replace the former name of `--stations`, with a note."""
    renamed = [re.sub(r"^--places(?==|$)", "--stations", word) for word in words]
    if renamed != words:
        from ..progress import say

        say("`--places` is now `--stations`; the former name works until the next version")
    return renamed, []


def _run(arguments: argparse.Namespace) -> None:
    """Write the briefing page of a run.

    Raises
    ------
    UsageError
        The name of the page does not end in .html, or its limit is too small for any content.
    """
    from .. import html_text, output
    from ..errors import UsageError
    from ..progress import READING, notify_if_slow, result, say
    from . import briefing, context, map_sheet, page, pdf, sheet_options

    if arguments.out.suffix.lower() != ".html":
        raise UsageError(f"--out: {arguments.out} does not end in .html; name an .html file")
    page.check_limit(arguments.limit)
    pdf.check(arguments.pdf, arguments.geopdf)
    for path in filter(None, (arguments.out, arguments.pdf, arguments.geopdf)):
        output.check(path, arguments.overwrite)
    if arguments.period and arguments.period[0] >= arguments.period[1]:
        raise UsageError("--period: its first time is not before its last; give the first time first")
    request = briefing.Request(
        arguments.scene,
        arguments.stations,
        arguments.film,
        arguments.against,
        arguments.limit,
        [context.parse(each) for each in arguments.context],
        sheet_options.of_arguments(arguments),
    )
    with notify_if_slow(READING):
        gathered = amend(arguments, briefing.gather(request))
    for note in page.notes(gathered):
        say(note)
    made = page.html(gathered, arguments.limit)
    output.write_text(arguments.out, made, arguments.overwrite)
    say(f"wrote one file of {html_text.size(len(made.encode()))}, which loads no other files")
    result(arguments.out)
    if arguments.pdf:
        pdf.write(arguments.out, arguments.pdf, arguments.overwrite)
        result(arguments.pdf)
    if arguments.geopdf:
        titles = sheet_options.Titles.of(gathered.run, gathered.sheet, gathered.zone)
        sheet = map_sheet.draw(gathered, gathered.sheet, titles)
        titled = titles.incident, titles.author
        pdf.write_geopdf(sheet, *titled, arguments.geopdf, arguments.overwrite)
        result(arguments.geopdf)


COMMAND = Command(
    "brief", "write a briefing page of a run", _DETAIL, RUNS, _run, _add, prepare=_rename_places
)
