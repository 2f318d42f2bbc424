"""Exercises: bases at towns with published positions, and invented resources.

Bases are not real stations, and resources, numbers and windows are not facts: all rows have the origin
``exercise``. Kinds and types are from NWCG PMS 200. Speeds, times, costs and line rates are rounded
assumptions of the exercise; `Resource.note` states this.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from zoneinfo import ZoneInfo

import numpy as np

from ..data import history
from ..run.labels import Label
from .records import Availability, Resource, Source, Station
from .station_file import StationFile
from .types import mode_of, standard_types

NOTE = "exercise assumption: speed, minutes, costs, load and line rate are round numbers, not facts"
KIND = "exercise base"
_TOWNS = ("town", "valley")
_DAY, _NIGHT = 6, 18  # local hours at which shifts begin
_SHARES = {"available": 0.75, "committed": 0.15, "unavailable": 0.10}


@dataclass(frozen=True)
class Assumptions:
    """Assumptions about a type; None: not applicable. Loads that follow from the tank are omitted.

    Attributes
    ----------
    often
        Mean number of resources at a base.
    """

    often: float
    speed_km_h: float
    mobilise_min: float
    cost_mobilise: float
    cost_hour: float
    cost_day: float
    staffing: str
    line_m_h: float | None = None
    load_kg: float | None = None
    radius_km: float | None = None
    night: bool = True


ASSUMPTIONS = {
    "engine/1": Assumptions(0.4, 55.0, 5.0, 200.0, 140.0, 2400.0, "career"),
    "engine/3": Assumptions(1.2, 60.0, 5.0, 150.0, 110.0, 1900.0, "career", line_m_h=120.0),
    "engine/4": Assumptions(0.5, 60.0, 8.0, 150.0, 100.0, 1700.0, "seasonal", line_m_h=90.0),
    "engine/6": Assumptions(0.8, 70.0, 6.0, 100.0, 80.0, 1400.0, "volunteer", line_m_h=80.0),
    "dozer/2": Assumptions(0.5, 40.0, 30.0, 600.0, 220.0, 3600.0, "call-when-needed", line_m_h=500.0),
    "crew/IHC": Assumptions(0.3, 60.0, 20.0, 400.0, 700.0, 11000.0, "seasonal", line_m_h=200.0, night=False),
    "crew/2IA": Assumptions(0.5, 60.0, 30.0, 300.0, 550.0, 9000.0, "seasonal", line_m_h=140.0, night=False),
    "helicopter/2": Assumptions(
        0.3, 180.0, 10.0, 500.0, 2500.0, 30000.0, "call-when-needed",
        load_kg=1000.0, radius_km=120.0, night=False,
    ),
    "airtanker/3": Assumptions(
        0.2, 280.0, 15.0, 800.0, 3500.0, 42000.0, "call-when-needed", radius_km=250.0, night=False
    ),
}  # fmt: skip
"""Assumptions by type; costs in US dollars."""


def towns(event: str) -> list[Label]:
    """Return the towns of a known fire with published positions (data/<event>.toml)."""
    places = history.load(event).places
    return [
        Label(each.name, each.latitude, each.longitude)
        for each in places
        if each.kind in _TOWNS and not each.approximate
    ]


def make_for_event(event: str, seed: int = 0) -> StationFile:
    """Make an exercise for a known fire: bases in its towns, windows from the ignition to the last report."""
    known = history.load(event)
    begins, ends = known.ignitions[0].time, known.acreages[-1].time
    positions = f"towns of data/{event}.toml, published and not verified one by one"
    return make(towns(event), begins, ends, known.zone, known.name, positions, seed)


def make(
    bases: Sequence[Label],
    begins: datetime,
    ends: datetime,
    zone: str,
    name: str,
    positions: str,
    seed: int = 0,
) -> StationFile:
    """Make an exercise; equal arguments give equal results.

    Parameters
    ----------
    begins, ends
        Period of the exercise, UTC, extended to complete local days.
    zone
        Time zone of the shifts.
    name
        Name of the fire.
    positions
        Source of the positions of the bases.
    """
    rng = np.random.default_rng(seed)
    day = begins.astimezone(ZoneInfo(zone)).date()
    source = Source(
        1,
        f"exercise for {name}, seed {seed}: invented resources; positions: {positions}",
        "as Firetwin",
        day.isoformat(),
    )
    stations = tuple(
        Station(
            number, f"Exercise base {base.name}", base.latitude, base.longitude, "exercise", source.id,
            kind=KIND, source_id=base.name,
        )
        for number, base in enumerate(bases, 1)
    )  # fmt: skip
    resources = tuple(_resources(stations, bases, source, rng))
    windows = tuple(
        window
        for resource in resources
        for window in _windows(resource, _shifts(begins, ends, ZoneInfo(zone)), rng)
    )
    return StationFile(stations, resources, windows, (source,), standard_types())


def _resources(
    stations: Sequence[Station], bases: Sequence[Label], source: Source, rng: np.random.Generator
) -> Iterator[Resource]:
    """Draw the resources of each base; the first base has at least one of each type."""
    number = 0
    for at, (station, base) in enumerate(zip(stations, bases, strict=True)):
        for code, assumed in ASSUMPTIONS.items():
            rows = int(rng.poisson(assumed.often))
            for row in range(1, max(rows, 1 if at == 0 else 0) + 1):
                number += 1
                yield _resource(number, station, base, code, row, source)


def _resource(number: int, station: Station, base: Label, code: str, row: int, source: Source) -> Resource:
    assumed, (kind, _, type_) = ASSUMPTIONS[code], code.partition("/")
    return Resource(
        number,
        station.id,
        code,
        f"Exercise {kind} {type_} {base.name} {row}",
        "exercise",
        source.id,
        load_kg=assumed.load_kg,
        speed_km_h=assumed.speed_km_h,
        mobilise_min=assumed.mobilise_min,
        radius_km=assumed.radius_km,
        line_m_h=assumed.line_m_h,
        cost_mobilise=assumed.cost_mobilise,
        cost_hour=assumed.cost_hour,
        cost_day=assumed.cost_day,
        currency="USD",
        mode=mode_of(code),
        staffing=assumed.staffing,
        night=assumed.night,
        note=NOTE,
    )


def _shifts(begins: datetime, ends: datetime, zone: ZoneInfo) -> list[tuple[datetime, datetime, bool]]:
    """Return the shifts of complete local days: start and end in UTC, and True for night."""
    first, last = begins.astimezone(zone).date(), ends.astimezone(zone).date()
    edges = [
        datetime(day.year, day.month, day.day, hour, tzinfo=zone).astimezone(UTC)
        for day in (first + timedelta(days=k) for k in range((last - first).days + 2))
        for hour in (_DAY, _NIGHT)
    ]
    shifts = list(itertools.pairwise(edges))[: 2 * ((last - first).days + 1)]
    return [(begin, end, k % 2 == 1) for k, (begin, end) in enumerate(shifts)]


def _windows(
    resource: Resource, shifts: Sequence[tuple[datetime, datetime, bool]], rng: np.random.Generator
) -> Iterator[Availability]:
    """Draw the status in each shift, and merge equal ones; at night only night resources are available."""
    drawn = rng.choice(len(_SHARES), len(shifts), p=list(_SHARES.values()))
    words = list(_SHARES)
    status, since, until = "", shifts[0][0], shifts[0][0]
    for (begin, end, night), index in zip(shifts, drawn.tolist(), strict=True):
        now = "unavailable" if night and not resource.night else words[index]
        if status and now != status:
            yield Availability(resource.id, since, until, status, "local")
            since = begin
        status, until = now, end
    yield Availability(resource.id, since, until, status, "local")
