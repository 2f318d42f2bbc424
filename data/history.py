"""Public facts about a fire, read from its TOML file in this folder."""

import tomllib
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

from ..errors import input_error

SQUARE_METRES_PER_ACRE = 4046.8564224  # international acre


class Acreage(NamedTuple):
    """A reported burned area: time (UTC), acres, source and assumptions."""

    time: datetime
    acres: float
    source: str
    note: str = ""


@dataclass(frozen=True)
class Ignition:
    """A published ignition point: time (UTC), degrees north and east."""

    time: datetime
    latitude: float
    longitude: float
    source: str


@dataclass(frozen=True)
class Place:
    """A named spot height in metres; `kind` is town, summit, lake or ridge."""

    name: str
    kind: str
    latitude: float
    longitude: float
    height: float
    approximate: bool


@dataclass(frozen=True)
class Reservoir:
    """A lake at full pool: height (m), width (m) and centre line [(latitude, longitude), ...]."""

    height: float
    width: float
    line: list[tuple[float, float]]


@dataclass(frozen=True)
class Event:
    """A fire and its area. Rivers run from mouth to head as [(latitude, longitude, height m), ...]."""

    name: str
    zone: str
    ignitions: list[Ignition]
    acreages: list[Acreage]
    places: list[Place]
    rivers: dict[str, list[tuple[float, float, float]]]
    reservoirs: dict[str, Reservoir]
    roads: dict[str, list[tuple[float, float]]]


def events() -> list[str]:
    """Return the names of the fires that `load` reads."""
    return sorted(path.stem for path in Path(__file__).parent.glob("*.toml"))


def load(event: str = "king_fire") -> Event:
    """Read `<event>.toml` of this folder.

    Raises
    ------
    firetwin_core.InputError
        No such fire, or the file is malformed.
    """
    path = Path(__file__).parent / f"{event}.toml"
    if event not in events():
        raise input_error(path, f"no fire is called {event!r}; known are: {', '.join(events())}")
    try:
        return _parse(tomllib.loads(path.read_text(encoding="utf-8")))
    except (tomllib.TOMLDecodeError, KeyError, TypeError, ValueError) as error:
        raise input_error(path, f"not a description of a fire: {error!r}") from error


def _parse(table: dict) -> Event:
    return Event(
        name=table["name"],
        zone=table["zone"],
        ignitions=[
            Ignition(entry["time"].astimezone(UTC), *entry["position"], source=entry["source"])
            for entry in table["ignition"]
        ],
        acreages=sorted(
            Acreage(
                entry["time"].astimezone(UTC), float(entry["acres"]), entry["source"], entry.get("note", "")
            )
            for entry in table["acreage"]
        ),
        places=[
            Place(spot["name"], spot["kind"], *spot["position"], spot["height"], trust == "approximate")
            for trust, spots in table["places"].items()
            for spot in spots
        ],
        rivers={name: [tuple(point) for point in line] for name, line in table["rivers"].items()},
        reservoirs={
            name: Reservoir(lake["height"], lake["width"], [tuple(point) for point in lake["line"]])
            for name, lake in table["reservoirs"].items()
        },
        roads={name: [tuple(point) for point in line] for name, line in table["roads"].items()},
    )
