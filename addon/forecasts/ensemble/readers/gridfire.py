"""Reader of GridFire: ``toa_0001_<simulation>.bin``, a list of burned cells of each simulation.

- Big-endian: n, columns (n), rows (n) as int32, then arrival times (n) as float32 in s, and other layers.
  Columns and rows count from 1, rows from the south; cells that burn at time 0 are not listed
  (pyregence/gridfire, binary_output.clj and simulations.clj). Any raster of the inputs gives the grid.
- ``summary_stats.csv``: a line for each simulation, with ignition (row and column from 0, rows from the
  north) and run time in minutes
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, input_error, reading
from ....files import check_text_size
from ....run.models import from_arrival_time, raster
from ....run.models.model import LONGEST, Options
from .. import write
from ..manifest import Manifest, Member
from ..member_set import MemberSet
from .files_in import add_member, files_in

NAME, ORDER = "GridFire", 30

_LIST = re.compile(r"toa_\d{4}_(\d{5})\.bin$")
_STATISTICS = re.compile(r"summary_stats.*\.csv$")
_COLUMNS = "simulation", "ignition-row", "ignition-col", "max-runtime"


@dataclass(frozen=True)
class _Simulation:
    """Ignition (row from the north and column, from 0) and run time (s)."""

    ignition: tuple[int, int]
    runtime: float


def sniff(paths: list[Path]) -> bool:
    """Check for lists of several simulations."""
    return len(_lists(files_in(paths))) > 1


def read(paths: list[Path], options: Options, horizon: float) -> MemberSet:
    """Read one member for each simulation."""
    files = files_in(paths)
    lists = _lists(files)
    first = next(iter(lists.values()))
    table = next((path for path in files if _STATISTICS.match(path.name)), None)
    known = _statistics(table) if table else {}
    like = next((path for path in files if raster.is_raster(path)), None)
    if like is None:
        raise input_error(first, "lists cells of a grid; give a raster of the inputs too, such as dem.tif")
    grid, note = raster.read(like).grid(options.projection, options.at)
    ignitions = len({each.ignition for each in known.values()})
    longest = max((each.runtime for each in known.values()), default=0.0)
    head = Manifest(
        name=options.name or first.parent.name,
        model=NAME,
        issued=from_arrival_time.begun(options, first),
        horizon=horizon or longest or max(60.0, *(_last(path) for path in lists.values())),
        members=(),
        zone=options.zone,
        source=f"{NAME}, {len(lists)} simulations of {first.parent.name}",
        kind="ignitions" if ignitions > 1 else "forecast",
    )
    notes = ["arrival times are in s, rows from the south", *([note] if note else [])]
    if ignitions > 1:
        notes.append(f"the simulations have {ignitions} ignitions, so they do not forecast one fire")
    if not known:
        notes.append("without summary_stats.csv the ignited cells, which burn at time 0, are not known")
    return MemberSet(head, grid, _members(lists, known, grid.shape, head.horizon), notes)


def _members(
    lists: dict[int, Path], known: dict[int, _Simulation], shape: tuple[int, int], horizon: float
) -> Iterator[write.Read]:
    for number in sorted({*lists, *known}):
        simulation = known.get(number)
        member = Member(f"{number:05}", end=simulation.runtime) if simulation else Member(f"{number:05}")
        if number not in lists:
            yield member, "is in summary_stats.csv, and has no arrival times"
            continue
        try:
            values = _arrival(lists[number], shape)
        except InputError as error:
            yield member, error
            continue
        if simulation and all(0 <= at < size for at, size in zip(simulation.ignition, shape, strict=True)):
            values[simulation.ignition] = 0.0
        values[values > horizon] = np.inf
        yield member, values if np.isfinite(values).any() else "nothing burns"


def _arrival(path: Path, shape: tuple[int, int]) -> NDArray[np.float32]:
    """Read arrival times (ny, nx), s; rows from the north, inf where unburned."""
    column, row, seconds = _burned(path)
    if not ((column >= 1) & (column <= shape[1]) & (row >= 1) & (row <= shape[0])).all():
        reason = f"has cell ({column.max()}, {row.max()}) where the raster has {shape[1]} x {shape[0]}"
        raise input_error(path, f"{reason}; give a raster of its inputs")
    if not (seconds >= 0.0).all():
        raise input_error(path, "has arrival times that are negative or not numbers; it is damaged")
    values = np.full(shape, np.inf, np.float32)
    values[shape[0] - row, column - 1] = seconds
    return values


def _burned(path: Path) -> tuple[NDArray, NDArray, NDArray]:
    """Read columns, rows and arrival times (n,) of a list."""
    with reading(path, "list of burned cells"):
        data = path.read_bytes()
    count = int(np.frombuffer(data, ">i4", 1)[0]) if len(data) >= 4 else -1
    if count < 0 or len(data) < 4 + 12 * count:
        raise input_error(path, f"holds {len(data):,} bytes, too few for its cells; copy it again")
    parts = np.frombuffer(data, ">i4", 2 * count, 4).reshape(2, count)
    return parts[0], parts[1], np.frombuffer(data, ">f4", count, 4 + 8 * count)


def _last(path: Path) -> float:
    """Return the last arrival of a simulation, s."""
    try:
        return float(_burned(path)[2].max(initial=0.0))
    except InputError:
        return 0.0


def _lists(files: list[Path]) -> dict[int, Path]:
    """Return the list of each simulation, by its number."""
    found: dict[int, Path] = {}
    for path in files:
        if match := _LIST.match(path.name):
            add_member(found, int(match[1]), path)
    return found


def _statistics(path: Path) -> dict[int, _Simulation]:
    """Read ignition and run time of each simulation."""
    with reading(path):
        check_text_size(path)
        with path.open(encoding="utf-8", newline="") as file:
            table = csv.DictReader(file)
            if not set(_COLUMNS) <= set(table.fieldnames or ()):
                raise input_error(path, f"has no columns {', '.join(_COLUMNS)}", line=1)
            found = {}
            for number, row in enumerate(table, 2):
                try:
                    simulation, down, across, minutes = (float(row[name]) for name in _COLUMNS)
                    found[int(simulation)] = _Simulation((int(down), int(across)), minutes * 60.0)
                except (TypeError, ValueError, OverflowError):
                    minutes = np.nan
                if not 0.0 <= minutes <= LONGEST / 60.0:
                    raise input_error(path, f"has no numbers {', '.join(_COLUMNS)}", line=number)
    return found
