"""Reader of ELMFIRE's Monte Carlo cases: an arrival map, or a list of burned cells, of each case.

- ``time_of_arrival_<case>_<seconds>.tif``: seconds, the last map of each case, whose simulation ends there
- ``toa_<band>_<case>.bin``: Fortran records of n, column, row, arrival time (s) and others; columns and rows
  count from 1, rows from the south (elmfire_io.f90). Any raster of the inputs gives their grid.
- ``fire_size_stats.csv``: a line for each case, with its weather band and ignition
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, input_error, reading
from ....run.models import from_arrival_time, raster
from ....run.models.model import Options
from ....run.readers import elmfire as run_reader
from .. import write
from ..manifest import Member
from ..member_set import MemberSet, attempt, burned, describe
from . import burned_cells
from .files_in import files_in, read_table

NAME, ORDER = "ELMFIRE", 40

_LIST = re.compile(r"toa_(\d{4})_(\d{7})$")
_STATISTICS = "fire_size_stats.csv"
_COLUMNS = "icase", "meteorology", "x", "y"
_MOST = 1 << 28  # burned cells of a case


def sniff(paths: list[Path]) -> bool:
    """Check for arrival maps or lists of several cases."""
    return len(_cases(files_in(paths))) > 1


def read(paths: list[Path], options: Options, horizon: float) -> MemberSet:
    """Read one member for each case."""
    files = files_in(paths)
    cases = _cases(files)
    first = next(iter(cases.values()))
    table = next((path for path in files if path.name == _STATISTICS), None)
    statistics = _statistics(table) if table else {}
    bands = {band for case, (band, _) in statistics.items() if case in cases} or _bands(cases)
    if len(bands) > 1:
        reason = f"its cases begin at {len(bands)} weather bands, and members have one start"
        raise input_error(table or first, f"{reason}; give the files of one band")
    like = raster.read(first) if _is_map(first) else burned_cells.read_inputs(files, first)
    grid, note = like.grid(options.projection, options.at)
    if not horizon:
        lists = [path for path in cases.values() if not _is_map(path)]
        ends = [float(run_reader.case_of(path)[1]) for path in cases.values() if _is_map(path)]
        horizon = max([burned_cells.last(_burned, lists), *ends])
    ignitions = len({ignition for case, (_, ignition) in statistics.items() if case in cases})
    source = f"{NAME}, {len(cases)} cases of {first.parent.name}"
    head, notes = describe(options, first, NAME, horizon, source, ignitions)
    members = burned(_members(cases, set(statistics), like), horizon)
    return MemberSet(head, grid, members, ["arrival times are in s", note, *notes])


def _members(cases: dict[str, Path], listed: set[str], like: raster.Raster) -> Iterator[write.Read]:
    for case in sorted({*cases, *listed}):
        path = cases.get(case)
        if path is None:
            yield Member(case), f"is in {_STATISTICS}, and has no arrival times"
        elif _is_map(path):
            arrival = attempt(raster.read, path)
            if isinstance(arrival, InputError):
                yield Member(case), arrival
                continue
            if difference := arrival.difference(like):
                raise input_error(path, f"{difference}; members need cells of one grid")
            member = Member(case, end=float(run_reader.case_of(path)[1]))
            yield member, from_arrival_time.arrival_times(arrival, run_reader.SECOND)
        else:
            yield Member(case), attempt(_list, path, (len(like.y), len(like.x)))


def _list(path: Path, shape: tuple[int, int]) -> NDArray[np.float32]:
    return burned_cells.place(path, _burned(path), shape)


def _burned(path: Path) -> burned_cells.Cells:
    """Read columns, rows and arrival times (n,) of a list of burned cells."""
    with reading(path, "list of burned cells"), path.open("rb") as file:
        count = int(np.frombuffer(_record(path, file, 4), "<i4")[0])
        if not 0 <= count <= _MOST:
            raise input_error(path, f"lists {count} cells; it is damaged")
        parts = [_record(path, file, count * size) for size in (2, 2, 4)]
    column, row = (np.frombuffer(part, "<i2").astype(np.int64) for part in parts[:2])
    return column, row, np.frombuffer(parts[2], "<f4")


def _record(path: Path, file: BinaryIO, size: int) -> bytes:
    """Read an unformatted Fortran record of this size: its length stands before and after it."""
    before, data, after = file.read(4), file.read(size), file.read(4)
    if len(data) != size or before != after or before != np.int32(size).tobytes():
        raise input_error(path, "is damaged or incomplete: its records have other lengths; copy it again")
    return data


def _is_map(path: Path) -> bool:
    return bool(run_reader.case_of(path)[0])


def _cases(files: list[Path]) -> dict[str, Path]:
    """Return the file of each case: the last arrival map, else the list."""
    latest: dict[str, tuple[int, Path]] = {}
    for path in files:
        case, seconds = run_reader.case_of(path)
        if (match := _LIST.match(path.stem)) and path.suffix == ".bin":
            case, seconds = match[2], "-1"
        if case and (case not in latest or int(seconds) > latest[case][0]):
            latest[case] = int(seconds), path
    return {case: path for case, (_, path) in sorted(latest.items())}


def _bands(cases: dict[str, Path]) -> set[str]:
    return {match[1] for path in cases.values() if (match := _LIST.match(path.stem))}


def _statistics(path: Path) -> dict[str, tuple[str, tuple[float, float]]]:
    """Read the weather band and the ignition (x, y) of each case."""
    cases = {}
    for number, (case, band, x, y) in read_table(path, _COLUMNS):
        try:
            cases[f"{int(case):07}"] = band, (float(x), float(y))
        except ValueError:
            raise input_error(path, "has a case without the numbers icase, x and y", line=number) from None
    return cases
