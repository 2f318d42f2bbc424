"""Arguments of `firetwin stations` and `firetwin resources`; no heavy module is imported here."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Callable
from datetime import date

from .. import argument_types as types
from .. import limits
from ..command import add_overwrite, add_verb
from .import_options import MEANINGS
from .records import DETOUR, MODES, STAFFING

STATIONS = """\
Makes and lists station files: stations and resources in a GeoPackage, which QGIS also opens.

  firetwin stations import stations.csv --out stations.gpkg
  firetwin stations exercise RUN --out exercise.gpkg
  firetwin stations info stations.gpkg

`import` reads fire stations from HIFLD (CSV, GeoJSON), the USGS (structures; GeoPackage, GeoJSON) and
OpenStreetMap (Overpass JSON, GeoJSON), other tables (CSV) and point layers (GeoPackage, GeoJSON) of stations,
CSV of resources (station, type), and station files. The format is detected from the content, columns from
their names (--column), and coordinates are degrees, Web Mercator or UTM (--crs). Stations within 150 m with
similar name and equal kind are merged. Telephone numbers and persons are never stored. `exercise` invents
resources at bases in towns around the fire of a run; everything in the file is labelled as an exercise."""

RESOURCES = """\
Lists the resources that meet all conditions, earliest arrival first. Response time is getaway time (order to
departure, column mobilise_min) plus travel time. Five terms are defined as follows. Response area: the
polygon of the station, otherwise the radius of the resource, otherwise the area that it reaches within
--minutes. Budget: mobilisation and --hours of work, summed. Delivery rate: water or retardant delivered by
round trips, t/h. Mode: attack, structure, drop, line, water, lift or command. Availability: the status at a
time.

With --tonnes-per-hour the result is the cheapest set that delivers this much; the exit status is 1 if there
is no such set within --budget. With --budget only, the result is the earliest resources that the budget pays
for. Units and assumptions are printed. With --run the list gives the time at which the fire reaches each
station, or the closest approach of the fire. For a file without resources the stations are listed, as with
--stations."""

_LENGTHS = {"": 1.0, "km": 1.0, "m": 0.001, "mi": 1.609344}


def add_stations(parser: argparse.ArgumentParser) -> None:
    """Define the verbs of `firetwin stations`."""
    verbs = parser.add_subparsers(dest="verb", metavar="VERB", required=True)

    def out(parser: argparse.ArgumentParser) -> None:
        parser.add_argument(
            "--out", metavar="STATIONS.gpkg", type=types.path, required=True, help="file to write"
        )
        add_overwrite(parser)

    verb = add_verb(verbs, "import", "make a station file from other files")
    verb.add_argument("files", metavar="FILE", nargs="+", type=types.path, help="files in any known format")
    out(verb)
    verb.add_argument("--source", metavar="NAME", default="", help="name of the source (by format)")
    verb.add_argument("--licence", metavar="TEXT", default="", help="licence of the data (by format)")
    verb.add_argument("--url", metavar="URL", default="", help="address of the source (by format)")
    verb.add_argument(
        "--date",
        metavar="DAY",
        type=_day,
        default=None,
        help="date of the data, such as 2026-11-25 (from the data or the file)",
    )
    verb.add_argument(
        "--column", metavar="MEANING=COLUMN", type=_column, action="append", default=[],
        help="column of tables and layers, such as name=Station_Name (guessed); repeat it",
    )  # fmt: skip
    verb.add_argument(
        "--crs", metavar="CODE", type=_crs,
        help="reference system of files that name none, such as EPSG:26910 or utm10n (degrees, Web Mercator)",
    )  # fmt: skip
    verb.add_argument(
        "--skip-bad", action="store_true", help="omit files that cannot be read or have no valid row"
    )

    exercise = add_verb(verbs, "exercise", "invent resources of an exercise around the fire of a run")
    exercise.add_argument(
        "run", metavar="RUN", type=types.path, help="run folder, or scene file (its first run)"
    )
    out(exercise)
    exercise.add_argument(
        "--towns", metavar="FILE", type=types.path,
        help="CSV or GeoJSON of bases: name, latitude, longitude (published towns of a known fire)",
    )  # fmt: skip
    exercise.add_argument("--seed", metavar="N", type=_seed, default=0, help="random seed (0)")

    info = add_verb(verbs, "info", "list the content of a station file")
    info.add_argument("file", metavar="STATIONS.gpkg", type=types.path, help="station file")
    info.add_argument("--json", action="store_true", help="write JSON")


def add_resources(parser: argparse.ArgumentParser) -> None:
    """Define the options of `firetwin resources`."""
    parser.add_argument("file", metavar="STATIONS.gpkg", type=types.path, help="station file")
    parser.add_argument(
        "--run", metavar="RUN", type=types.path, help="run folder, or scene file (its first run)"
    )
    parser.add_argument(
        "--near", metavar="PLACE", type=_place,
        help="destination: LAT,LON; with --run also ignition, or head (of the fire at --available-at)",
    )  # fmt: skip
    parser.add_argument(
        "--within", metavar="LENGTH", type=_length, help="maximum straight distance, such as 60km or 40mi"
    )
    parser.add_argument(
        "--minutes",
        metavar="N",
        type=_positive,
        help="maximum response time, from the order to the arrival, min",
    )
    parser.add_argument("--kind", metavar="LIST", type=_words, default=(), help="kinds, such as engine,dozer")
    parser.add_argument(
        "--type", metavar="LIST", type=parse_types, default=(), help="types, such as 3, 1-3 or VLAT"
    )
    parser.add_argument(
        "--mode",
        metavar="LIST",
        type=_among(MODES),
        default=(),
        help="operational modes, such as attack,drop",
    )
    parser.add_argument(
        "--staffing",
        metavar="LIST",
        type=_among(STAFFING),
        default=(),
        help="employment, such as career or volunteer",
    )
    parser.add_argument("--night", action="store_true", help="only resources that work at night")
    parser.add_argument(
        "--available-at",
        metavar="TIME",
        type=types.moment,
        help="time of availability, such as 2014-09-17T16:00-07:00",
    )
    parser.add_argument(
        "--tonnes-per-hour", metavar="T", type=_positive, help="minimum water or retardant delivered, t/h"
    )
    parser.add_argument("--budget", metavar="COST", type=_positive, help="maximum cost of the set")
    parser.add_argument(
        "--currency", metavar="CODE", default="USD", type=str.upper, help="currency of the budget (USD)"
    )
    for name, unit, usual, what in (
        ("hours", "H", 12.0, "paid hours of work"),
        ("detour", "FACTOR", DETOUR, "ratio of road length to straight distance"),
        ("refill", "KM", 5.0, "distance to the refill point, km; air tankers fill at their base"),
        ("turnaround", "MIN", 10.0, "time to fill and discharge in a round trip, min"),
    ):
        help = f"{what} ({usual:g})"
        parser.add_argument(f"--{name}", metavar=unit, type=_positive, default=usual, help=help)
    parser.add_argument(
        "--ahead",
        action="store_true",
        help="only stations that the fire of --run reaches, earliest first",
    )
    parser.add_argument(
        "--clearance", metavar="LENGTH", type=_length, default=0.5,
        help="distance to the fire up to which --ahead lists stations that do not burn (500m)",
    )  # fmt: skip
    parser.add_argument("--stations", action="store_true", help="list stations instead of resources")
    parser.add_argument("--json", action="store_true", help="write JSON")


def _place(text: str) -> str | tuple[float, float]:
    if text in ("ignition", "head"):
        return text
    try:
        latitude, longitude = (float(part) for part in text.split(","))
    except ValueError:
        latitude = longitude = math.nan
    if not (abs(latitude) <= 90.0 and abs(longitude) <= 180.0):
        raise argparse.ArgumentTypeError(
            f"must be ignition, head, or degrees north and east such as 38.78,-120.60, not {text!r}"
        )
    return latitude, longitude


def _length(text: str) -> float:
    match = re.fullmatch(r"(\d+(?:\.\d+)?) ?([a-z]*)", text.strip().lower(), re.ASCII)
    if not match or match[2] not in _LENGTHS or float(match[1]) <= 0.0:
        raise argparse.ArgumentTypeError(f"must be a length such as 60km, 500m or 40mi, not {text!r}")
    return float(match[1]) * _LENGTHS[match[2]]


def _positive(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not limits.is_quantity(value) or value == 0.0:
        most = f"{limits.LARGEST_NUMBER:,.0f}"
        raise argparse.ArgumentTypeError(f"must be a number above 0 and at most {most}, not {text!r}")
    return value


def _seed(text: str) -> int:
    if not (text.isascii() and text.isdecimal() and len(text) < 10):
        raise argparse.ArgumentTypeError(f"must be a whole number from 0, not {text!r}")
    return int(text)


def _day(text: str) -> str:
    try:
        day = date.fromisoformat(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a day such as 2026-11-25, not {text!r}") from None
    first, last = limits.RUN_YEARS
    if not first <= day.year <= last:
        raise argparse.ArgumentTypeError(f"must be in the years {first} to {last}, not {text!r}")
    return day.isoformat()


def _column(text: str) -> tuple[str, str]:
    meaning, _, column = (part.strip() for part in text.partition("="))
    if meaning not in MEANINGS or not column:
        raise argparse.ArgumentTypeError(
            f"must have the form name=Station_Name, not {text!r}; known are {', '.join(MEANINGS)}"
        )
    return meaning, column


def _crs(text: str) -> str:
    plain = text.strip().lower().replace(" ", "")
    if match := re.fullmatch(r"utm(?:zone)?(\d{1,2})([ns])", plain):
        if 1 <= int(match[1]) <= 60:
            return f"EPSG:{326 if match[2] == 'n' else 327}{int(match[1]):02d}"
    elif match := re.fullmatch(r"(?:epsg:+)?(\d{4,6})", plain):
        return f"EPSG:{match[1]}"
    raise argparse.ArgumentTypeError(f"must be a code such as EPSG:26910, EPSG:3857 or utm10n, not {text!r}")


def _words(text: str) -> tuple[str, ...]:
    found = tuple(part.strip().lower() for part in text.split(",") if part.strip())
    if not found:
        raise argparse.ArgumentTypeError("is empty; give words with commas between them")
    return found


def parse_types(text: str) -> tuple[str, ...]:
    """Parse a list of types such as ``1-3,VLAT``.

    Raises
    ------
    argparse.ArgumentTypeError
        The list is empty, or a range goes backwards.
    """
    types: list[str] = []
    for part in _words(text):
        match = re.fullmatch(r"(\d)-(\d)", part, re.ASCII)
        if match and match[1] > match[2]:
            raise argparse.ArgumentTypeError(f"{part!r} goes backwards; write {match[2]}-{match[1]}")
        types += [str(k) for k in range(int(match[1]), int(match[2]) + 1)] if match else [part]
    return tuple(types)


def _among(known: tuple[str, ...]) -> Callable[[str], tuple[str, ...]]:
    def words(text: str) -> tuple[str, ...]:
        found = _words(text)
        for word in found:
            if word not in known:
                raise argparse.ArgumentTypeError(f"{word!r} is not one of {', '.join(known)}")
        return found

    return words
