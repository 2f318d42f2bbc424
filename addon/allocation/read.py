"""Units for an allocation: the available resources of a station file at a time, unit by unit."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

from ..errors import input_error
from ..stations import measures, reading
from ..stations.records import Resource
from ..stations.station_file import StationFile
from .resources import Unit

_MOST = 10_000  # maximum number of units of one row


def read(path: Path, moment: datetime) -> tuple[list[Unit], list[str]]:
    """Read the units that are available at a time, and messages on the unavailable ones.

    A row with several units gives units with ids such as 7-1 and 7-2. A resource without windows of
    availability is available.

    Raises
    ------
    InputError
        The file is not a station file, is damaged, or has costs in several currencies.
    """
    station_file = reading.read(path)
    units: list[Unit] = []
    left: list[str] = []
    for resource, window in zip(
        station_file.resources, measures.windows_at(station_file, moment).tolist(), strict=True
    ):
        status = _status(station_file, resource, window)
        if status == "available":
            units += _units(path, station_file, resource)
        else:
            left.append(f"{_title(station_file, resource)} ({resource.type}) is {status}")
    _one_currency(path, units)
    return units, left


def _status(station_file: StationFile, resource: Resource, window: int) -> str:
    if window >= 0:
        return station_file.availability[int(station_file.windows.number[window])].status
    return "of unknown status then" if station_file.windows_of[resource.id] else "available"


def _title(station_file: StationFile, each: Resource) -> str:
    return each.name or station_file.stations[station_file.station_row[each.station]].title


def _units(path: Path, station_file: StationFile, each: Resource) -> list[Unit]:
    if each.count > _MOST:
        raise input_error(path, f"resource {each.id} has a count of {each.count:,}, above {_MOST:,}")
    station = station_file.stations[station_file.station_row[each.station]]
    one = Unit(
        str(each.id), each.type, each.line_m_h, each.mobilise_min, each.speed_km_h, each.cost_hour,
        station.latitude, station.longitude, _title(station_file, each), each.origin,
        each.currency, each.cost_mobilise, each.cost_day, station.title,
    )  # fmt: skip
    if each.count == 1:
        return [one]
    return [
        one._replace(id=f"{each.id}-{k}", name=f"{one.name} ({k} of {each.count})")
        for k in range(1, each.count + 1)
    ]


def _one_currency(path: Path, units: list[Unit]) -> None:
    names = sorted({unit.currency for unit in units if unit.currency})
    if len(names) > 1:
        reason = f"has costs in {' and '.join(names)}; an allocation needs one currency: convert them"
        raise input_error(path, reason)
