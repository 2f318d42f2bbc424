"""Column names of tables and layers of stations: guessed from usual spellings, or given by the user."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from ...errors import input_error
from .. import import_rows

_SPELLINGS = {
    "name": ("name stationname facilityname facname stnname fsname station facility title label featurename"),
    "latitude": "latitude lat latdd declat latdec ylat latitudedd",
    "longitude": "longitude lon lng long londd longdd declon declong londec xlon",
    "x": "x xcoord pointx easting coordx xcoordinate east",
    "y": "y ycoord pointy northing coordy ycoordinate north",
    "kind": "kind type stationtype facilitytype factype typename",
    "agency": (
        "agency operator department dept agencyname departmentname deptname firedepartment "
        "firedistrict district jurisdiction organization"
    ),
    "staffing": "staffing staffingtype stafftype staffed staff careervolunteer",
    "address": "address streetaddress fulladdress siteaddress address1 addr",
    "city": "city town municipality",
    "state": "state stateabbr",
    "zip": "zip zipcode postcode postalcode",
    "source_id": (
        "id number sourceid ref stationno stationnumber stationnum stationid stnno facilityid objectid fid"
    ),
    "origin": "origin",
    "date": (
        "editdate lasteditdate lastediteddate lastupdate lastupdated dateupdated updated "
        "modified datemodified geodate loaddate"
    ),
}
"""Usual spellings by meaning, in lower case without other characters than letters and digits; best first."""

_NOT_A_STATION = re.compile(
    "city|county|state|agency|dep|district|owner|street|road|layer|file|user|first|last|region|unit|type|area"
)
_SHOWN = 12  # columns in a message


def find_columns(path: Path, columns: Iterable[str], given: Mapping[str, str]) -> dict[str, str]:
    """Map meanings to column names of a file, as they are spelled there.

    Columns with telephone numbers and persons are never used.

    Raises
    ------
    InputError
        A given column is missing, or has persons.
    """
    named = [str(column) for column in columns]
    private = set(import_rows.private_columns(named))
    plain: dict[str, str] = {}
    for name in named:
        if name not in private:
            plain.setdefault(_simplify(name), name)
    column_of = {}
    for meaning, spellings in _SPELLINGS.items():
        spelling = next((each for each in spellings.split() if each in plain), None)
        if spelling is not None:
            column_of[meaning] = plain[spelling]
    if "name" not in column_of:
        others = [name for key, name in plain.items() if "name" in key and not _NOT_A_STATION.search(key)]
        column_of.update(zip(("name",), others, strict=False))
    for meaning, wanted in given.items():
        match = next((name for name in named if name.strip().lower() == wanted.strip().lower()), None)
        if match is None or match in private:
            why = "is not read, as it has persons or telephone numbers" if match else "does not exist"
            raise input_error(path, f"column {wanted} {why}; the columns are {format_columns(named)}")
        column_of[meaning] = match
    return column_of


def check_needed(path: Path, columns: Iterable[str], column_of: Mapping[str, str], position: bool) -> None:
    """Check that a file has columns for the name or number, and for the position if it is a table.

    Raises
    ------
    InputError
        A column is missing; the message lists the columns of the file.
    """
    missing = [] if "name" in column_of or "source_id" in column_of else ["name"]
    if position and not has_position(column_of):
        missing += [
            one for one, other in (("latitude", "y"), ("longitude", "x")) if not {one, other} & set(column_of)
        ]
        missing = missing if len(missing) > ("name" in missing) else [*missing, "latitude", "longitude"]
    if missing:
        options = " ".join(f"--column {each}=COLUMN" for each in missing)
        reason = (
            f"has no column for {' and '.join(missing)}: it has {format_columns(columns)}; name it: {options}"
        )
        raise input_error(path, reason)


def has_position(found: Mapping[str, str]) -> bool:
    """Return True if columns of a position are known: in degrees, or x and y."""
    return {"latitude", "longitude"} <= set(found) or {"x", "y"} <= set(found)


def format_columns(columns: Iterable[str]) -> str:
    """List column names for a message, the first ones of many."""
    named = [str(each)[:40] for each in columns]
    more = f" and {len(named) - _SHOWN} more" if len(named) > _SHOWN else ""
    return ", ".join(named[:_SHOWN]) + more


def _simplify(name: str) -> str:
    plain = name.partition("(")[0].partition("[")[0].lower()
    return re.sub(r"[^a-z0-9]", "", plain)
