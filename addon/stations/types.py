"""Types of fire resources in NWCG PMS 200, and their codes.

Source: NWCG Standards for Wildland Fire Resource Typing, PMS 200, with its tables of equipment, aircraft
and crews (https://www.nwcg.gov/publications/pms200), read in November 2026. All values are minima. The tables
give no tank of helicopters, so it is missing here.
"""

from __future__ import annotations

import re

from .records import AIR, Type

STANDARD = "NWCG PMS 200, read in November 2026"
OWN = "user"
"""Standard of a type that is not in PMS 200."""

_GALLON, _POUND = 3.785411784, 0.45359237  # l, kg

# each type: tank gal, pump gal/min, people
_ENGINES: dict[str, tuple[float, float, int]] = {
    "1": (300, 1000, 4),
    "2": (300, 500, 3),
    "3": (500, 150, 3),
    "4": (750, 50, 2),
    "5": (400, 50, 2),
    "6": (150, 50, 2),
    "7": (50, 10, 2),
}
# gal of each type; the standard gives only a maximum (799) for type 4
_AIRTANKERS: dict[str, float | None] = {"VLAT": 8000, "1": 3000, "2": 1800, "3": 800, "4": None}
_HELICOPTERS = {"1": 5000, "2": 2500, "3": 1200}  # payload of each type, lb at 59 F and sea level
_DOZERS = ("1", "2", "3", "4")
_CREWS = {"IHC": 18, "2IA": 18, "2": 18}  # people of each type

_CODE = re.compile(r"[a-z][a-z -]{0,30}/[A-Za-z0-9 -]{1,12}")

MODE_OF = {
    "engine": "attack",
    "airtanker": "drop",
    "helicopter": "drop",
    "dozer": "line",
    "crew": "line",
    "tender": "water",
    "command": "command",
}
"""Default operational mode by kind; other kinds attack on the ground."""


def standard_types() -> tuple[Type, ...]:
    """Return all types of the standard."""
    engines = (
        Type(f"engine/{n}", "engine", "structure" if n in "12" else "wildland", n, tank * _GALLON,
             pump_l_min=pump * _GALLON, people=people, standard=STANDARD)
        for n, (tank, pump, people) in _ENGINES.items()
    )  # fmt: skip
    tankers = (
        Type(f"airtanker/{n}", "airtanker", "aircraft", n, tank and tank * _GALLON, standard=STANDARD)
        for n, tank in _AIRTANKERS.items()
    )
    helicopters = (
        Type(f"helicopter/{n}", "helicopter", "aircraft", n, payload_kg=load * _POUND, standard=STANDARD)
        for n, load in _HELICOPTERS.items()
    )
    dozers = (Type(f"dozer/{n}", "dozer", "equipment", n, standard=STANDARD) for n in _DOZERS)
    crews = (
        Type(f"crew/{n}", "crew", "crew", n, people=people, standard=STANDARD) for n, people in _CREWS.items()
    )
    return (*engines, *tankers, *helicopters, *dozers, *crews)


def user_type(code: str) -> Type | None:
    """Make a type from a user-defined code, such as ``tender/1``; None if the code has another form."""
    if not _CODE.fullmatch(code):
        return None
    kind, _, number = code.partition("/")
    return Type(code, kind, "aircraft" if kind in AIR else "", number, standard=OWN)


def mode_of(code: str) -> str:
    """Return the default operational mode of a type; engines of types 1 and 2 protect structures."""
    if code in ("engine/1", "engine/2"):
        return "structure"
    return MODE_OF.get(code.partition("/")[0], "attack")
