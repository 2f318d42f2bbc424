"""`firetwin score`: a run against observations of its fire."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from .. import argument_types as types
from ..command import RUNS, Command, add_overwrite
from ..progress import result, say
from ._scene_runs import is_scene, open_runs

_DETAIL = """\
FILE holds dated perimeters (.geojson, .shp, .kml, .kmz, .gpkg) or FIRMS detections of VIIRS and MODIS
(.csv). Append the date to a file without dates: FILE@2014-09-18T04:00-07:00. Scores by date: areas, Sorensen,
Jaccard, kappa, precision, recall, shape deviation and area difference indices, and distances of the
perimeters, with and without the area burned before the start of the run. Further scores: errors of arrival
times, and detections with their lag. Each score is computed on polygons and on cells; their difference
estimates the numerical error of the score, not of the fire model. Observations outside the times or the grid
of the run are counted and ignored. The exit status is 1 if none remains. Needs shapely and pyproj (pip
install 'firetwin[score]')."""


def _add(parser: argparse.ArgumentParser) -> None:
    """Define the arguments."""
    parser.add_argument(
        "run",
        metavar="RUN",
        type=types.path,
        help="run folder, or a scene file, whose first run is scored against the second",
    )
    parser.add_argument(
        "--against",
        metavar="FILE|RUN",
        nargs="+",
        default=[],
        help="observed perimeters, detections, or another run (RUN/observations)",
    )
    parser.add_argument(
        "--report",
        metavar="X.html",
        type=types.path,
        help="write an HTML report with maps and curves (none)",
    )
    parser.add_argument("--json", action="store_true", help="write JSON")
    add_overwrite(parser)


def _run(arguments: argparse.Namespace) -> None:
    """Compare a run with observations of its fire."""
    from .. import output
    from ..errors import Error, UsageError, input_error
    from ..run import observations, readers, zone
    from ..run import score as scores
    from ..run.score import page, used

    if is_scene(arguments.run):
        run, *others = open_runs(arguments.run).values()
        named = arguments.against or [other.path for other in others]
    else:
        run = readers.open(arguments.run)
        named = arguments.against or observations.beside(arguments.run)
    runs = [readers.open(Path(each)) for each in named if not observations.is_one(each)]
    if len(runs) > 1:
        raise UsageError("--against: accepts one other run; remove the others")
    if arguments.report and arguments.report.suffix.lower() != ".html":
        raise UsageError(f"--report: {arguments.report} does not end in .html; name an .html file")
    if arguments.report:
        output.check(arguments.report, arguments.overwrite)
    observed = observations.read(each for each in named if observations.is_one(each))
    if observed.heat and not (observed.perimeters or observed.detections or runs):
        raise input_error(named[0], "has detections but no perimeter; name a file with a perimeter")
    comparison = scores.score(run, observed, runs[0] if runs else None, zone=zone.time_zone(run))
    result(json.dumps(comparison, indent=1) if arguments.json else page.page(comparison))
    if arguments.report:
        from ..run.score import report

        text = report.html(run, comparison, observed, *runs)
        output.write_text(arguments.report, text, arguments.overwrite)
        say(f"wrote {arguments.report}")
    if not runs and (none := used.nothing(comparison["uses"])):
        raise Error(none)


COMMAND = Command("score", "score a run against observations of its fire", _DETAIL, RUNS, _run, _add)
