"""Reader of GridFire: ``toa_0001_<simulation>.bin``, a list of burned cells of each simulation.

- Big-endian: n, columns (n), rows (n) as int32, then arrival times (n) as float32 in s, and other layers.
  Columns and rows count from 1, rows from the south; cells that burn at time 0 are not listed
  (pyregence/gridfire, binary_output.clj and simulations.clj). Any raster of the inputs gives the grid.
- ``summary_stats.csv``: a line for each simulation, with ignition (row and column from 0, rows from the
  north) and run time in minutes
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....errors import input_error, reading
from ....files import check_size
from ....limits import UNPACKED_BYTES
from ....run.models.model import LONGEST, Options
from .. import write
from ..manifest import Member
from ..member_set import MemberSet, attempt, burned, describe
from . import burned_cells
from .files_in import add_member, files_in, read_table

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
    simulations = _statistics(table) if table else {}
    grid, note = burned_cells.read_inputs(files, first).grid(options.projection, options.at)
    ignitions = len({each.ignition for each in simulations.values()})
    longest = max((each.runtime for each in simulations.values()), default=0.0)
    horizon = horizon or longest or burned_cells.last(_burned, lists.values())
    source = f"{NAME}, {len(lists)} simulations of {first.parent.name}"
    head, notes = describe(options, first, NAME, horizon, source, ignitions)
    if not simulations:
        notes.append("without summary_stats.csv the ignited cells, which burn at time 0, are not known")
    members = burned(_members(lists, simulations, grid.shape), horizon)
    return MemberSet(head, grid, members, ["arrival times are in s, rows from the south", note, *notes])


def _members(
    lists: dict[int, Path], simulations: dict[int, _Simulation], shape: tuple[int, int]
) -> Iterator[write.Read]:
    for number in sorted({*lists, *simulations}):
        simulation = simulations.get(number)
        member = Member(f"{number:05}", end=simulation.runtime if simulation else math.inf)
        if number in lists:
            yield member, attempt(_arrival, lists[number], shape, simulation)
        else:
            yield member, "is in summary_stats.csv, and has no arrival times"


def _arrival(path: Path, shape: tuple[int, int], simulation: _Simulation | None) -> NDArray[np.float32]:
    values = burned_cells.place(path, _burned(path), shape)
    if simulation and all(0 <= at < size for at, size in zip(simulation.ignition, shape, strict=True)):
        values[simulation.ignition] = 0.0
    return values


def _burned(path: Path) -> burned_cells.Cells:
    """Read columns, rows and arrival times (n,) of a list."""
    with reading(path, "list of burned cells"):
        check_size(path, UNPACKED_BYTES)
        data = path.read_bytes()
    count = int(np.frombuffer(data, ">i4", 1)[0]) if len(data) >= 4 else -1
    if count < 0 or len(data) < 4 + 12 * count:
        raise input_error(path, f"holds {len(data):,} bytes, too few for its cells; copy it again")
    parts = np.frombuffer(data, ">i4", 2 * count, 4).reshape(2, count)
    return parts[0], parts[1], np.frombuffer(data, ">f4", count, 4 + 8 * count)


def _lists(files: list[Path]) -> dict[int, Path]:
    """Return the list of each simulation, by its number."""
    lists: dict[int, Path] = {}
    for path in files:
        if match := _LIST.match(path.name):
            add_member(lists, int(match[1]), path)
    return lists


def _statistics(path: Path) -> dict[int, _Simulation]:
    """Read ignition and run time of each simulation."""
    simulations = {}
    for line, words in read_table(path, _COLUMNS):
        try:
            number, row, column, minutes = map(float, words)
            simulations[int(number)] = _Simulation((int(row), int(column)), minutes * 60.0)
        except (ValueError, OverflowError):
            minutes = np.nan
        if not 0.0 <= minutes <= LONGEST / 60.0:
            raise input_error(path, f"has no numbers {', '.join(_COLUMNS)}", line=line)
    return simulations
