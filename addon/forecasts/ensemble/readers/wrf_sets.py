"""Reader of WRF-SFIRE sets in one netCDF file: FIRE_AREA (ens, Time, y, x), FXLONG and FXLAT.

Names as in wirc-sjsu/Fire_Risk_Exercise. A member that ended early is padded with NaN. This
does not mean unburned: the member ends at its last time with values.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....errors import input_error
from ....run.models import arrival, from_arrival_time, netcdf
from ....run.models.grid import Grid
from ....run.models.model import Options
from .. import write
from ..manifest import Member
from ..member_set import MemberSet, burned, describe
from .files_in import files_in

NAME, ORDER = "WRF-SFIRE sets", 70

_AREA = "FIRE_AREA"
_UNITS = {"seconds": 1.0, "minutes": 60.0, "hours": 3600.0, "days": 86400.0}


def sniff(paths: list[Path]) -> bool:
    """Check for a netCDF file with the dimension `ens` and the variable FIRE_AREA."""
    return _file(paths) is not None


def read(paths: list[Path], options: Options, horizon: float) -> MemberSet:
    """Read one member for each entry of the dimension `ens`."""
    path = _file(paths)
    assert path is not None
    file = netcdf.File(path)
    shape = file.shape(_AREA)
    if len(shape) != 4:
        raise file.error(f"{_AREA} has {len(shape)} axes, not ens, Time, y and x")
    moments, said = _moments(file, options)
    if len(moments) != shape[1]:
        raise file.error(f"has {len(moments)} times, and {_AREA} has {shape[1]}")
    seconds = np.array([(moment - moments[0]).total_seconds() for moment in moments])
    if (np.diff(seconds) <= 0.0).any():
        raise file.error("its times do not ascend")
    grid = Grid(_place(file, "FXLAT", shape), _place(file, "FXLONG", shape))
    source = f"{shape[0]} members of {path.name}"
    started = replace(options, start=moments[0])
    head, _ = describe(started, path, "WRF-SFIRE", horizon or float(seconds[-1]), source)
    head = replace(head, name=options.name or path.stem)
    notes = [said, "a cell arrives when half of it has burned, linear between two times"]
    return MemberSet(head, grid, burned(_members(file, shape, seconds), math.inf), notes)


def _members(file: netcdf.File, shape: tuple[int, ...], seconds: NDArray[np.float64]) -> Iterator[write.Read]:
    names = _names(file, shape[0])
    for index, name in enumerate(names):
        filled = [not np.isnan(file.read(_AREA, index, time)).all() for time in range(shape[1])]
        count = [*filled, False].index(False)
        member = Member(name, end=float(seconds[count - 1]) if count else 0.0)
        if count and not any(filled[count:]):
            yield member, arrival.from_share(seconds[:count], partial(file.read, _AREA, index), shape[2:])
        else:
            reason = f"has values again after a gap at time {count + 1}" if count else "has no values"
            yield member, reason
    file.close()


def _moments(file: netcdf.File, options: Options) -> tuple[list[datetime], str]:
    """Return the times of the set: a CF coordinate, or the option --start with hours."""
    for name in ("Time", "time", "XTIME"):
        if name not in file:
            continue
        units = str(file.attribute("units", name, otherwise=""))
        match = re.fullmatch(r"(seconds|minutes|hours|days) since (\S+)(?:[ T](\S+))?", units.strip())
        if match is None:
            continue
        start = datetime.fromisoformat(f"{match[2]}T{match[3] or '00:00:00'}".replace("Z", "+00:00"))
        start = start if start.tzinfo else start.replace(tzinfo=UTC)
        values = np.asarray(file.read(name), np.float64).ravel() * _UNITS[match[1]]
        return [start + timedelta(seconds=float(value)) for value in values], f"times are {name}"
    begun = from_arrival_time.begun(options, file.path)
    hours = range(file.shape(_AREA)[1])
    return [
        begun + timedelta(hours=hour) for hour in hours
    ], "no time coordinate: times are hourly from --start"


def _place(file: netcdf.File, name: str, shape: tuple[int, ...]) -> NDArray[np.float64]:
    """Read coordinates (y, x); sets repeat them for each member and time."""
    size = len(file.shape(name))
    values = np.asarray(file.read(name, *[0] * (size - 2)), np.float64)
    if values.shape != shape[2:]:
        raise input_error(file.path, f"has {name} {values.shape}, and {_AREA} has {shape[2:]} cells")
    return values


def _names(file: netcdf.File, count: int) -> list[str]:
    if "ens" not in file or file.shape("ens") != (count,):
        return [f"{index:02}" for index in range(count)]
    with file.sense():
        return [str(value) for value in np.asarray(file.variables["ens"][:])]


def _file(paths: list[Path]) -> Path | None:
    for path in files_in(paths):
        dimensions, variables = netcdf.names(path)
        if "ens" in dimensions and _AREA in variables:
            return path
    return None
