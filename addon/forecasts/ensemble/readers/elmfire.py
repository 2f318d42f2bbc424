"""Reader of ELMFIRE's Monte Carlo cases: an arrival map, or a list of burned cells, of each case.

- ``time_of_arrival_<case>_<seconds>.tif``: seconds, the last map of each case
- ``toa_<band>_<case>.bin``: Fortran records of n, column, row, arrival time (s) and others; columns and rows
  count from 1, rows from the south (elmfire_io.f90). Any raster of the inputs gives their grid.
- ``fire_size_stats.csv``: a line for each case, with its weather band and ignition
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, input_error, reading
from ....files import check_text_size
from ....run.models import from_arrival_time, raster
from ....run.models.model import Options
from .. import write
from ..manifest import Manifest, Member
from ..member_set import MemberSet
from .files_in import files_in

NAME, ORDER = "ELMFIRE", 40

_MAP = re.compile(r"time_of_arrival_(\d{7})_(\d+)$")
_LIST = re.compile(r"toa_(\d{4})_(\d{7})$")
_STATISTICS = "fire_size_stats.csv"
_COLUMNS = "icase", "meteorology", "x", "y"  # beginnings of names, in lower case
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
    known = _statistics(table) if table else {}
    bands = {row["band"] for case, row in known.items() if case in cases} or _bands(cases)
    if len(bands) > 1:
        reason = f"its cases begin at {len(bands)} weather bands, and members have one start"
        raise input_error(table or first, f"{reason}; give the files of one band")
    like = raster.read(first) if _MAP.match(first.stem) else _any_raster(files, first)
    grid, note = like.grid(options.projection, options.at)
    ignitions = len({row["ignition"] for case, row in known.items() if case in cases})
    head = Manifest(
        name=options.name or first.parent.name,
        model="ELMFIRE",
        issued=from_arrival_time.begun(options, first),
        horizon=horizon or max(60.0, *(_last(path) for path in cases.values())),
        members=(),
        zone=options.zone,
        source=f"{NAME}, {len(cases)} cases of {first.parent.name}",
        kind="ignitions" if ignitions > 1 else "forecast",
    )
    notes = ["arrival times are in s", *([note] if note else [])]
    if ignitions > 1:
        notes.append(f"the cases have {ignitions} ignitions, so they do not forecast one fire")
    return MemberSet(head, grid, _members(cases, set(known), like, head.horizon), notes)


def _members(
    cases: dict[str, Path], known: set[str], like: raster.Raster, horizon: float
) -> Iterator[write.Read]:
    shape = len(like.y), len(like.x)
    for case in sorted({*cases, *known}):
        member = Member(case)
        if case not in cases:
            yield member, f"is in {_STATISTICS}, and has no arrival times"
            continue
        try:
            found = raster.read(cases[case]) if _MAP.match(cases[case].stem) else None
            values = _map(found) if found else _list(cases[case], shape)
        except InputError as error:
            yield member, error
            continue
        if found and not found.has_cells_of(like):
            reason = f"has other cells than {like.path.name}; members need cells of one grid"
            raise input_error(cases[case], reason)
        values[~(values <= horizon)] = np.inf
        yield member, values if np.isfinite(values).any() else "nothing burns"


def _map(found: raster.Raster) -> NDArray[np.float32]:
    """Return the arrival times of a map, s; inf without data."""
    return np.where(found.values >= 0.0, found.values, np.inf).astype(np.float32)


def _list(path: Path, shape: tuple[int, int]) -> NDArray[np.float32]:
    """Read the arrival times (ny, nx) of a list of burned cells, s; rows from the north, inf elsewhere."""
    column, row, seconds = _burned(path)
    inside = (column >= 1) & (column <= shape[1]) & (row >= 1) & (row <= shape[0])
    if not inside.all():
        reason = f"has cell ({column.max()}, {row.max()}) where the raster has {shape[1]} x {shape[0]}"
        raise input_error(path, f"{reason}; give a raster of its inputs")
    values = np.full(shape, np.inf, np.float32)
    np.minimum.at(values, (shape[0] - row, column - 1), seconds)
    return values


def _burned(path: Path) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float32]]:
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


def _last(path: Path) -> float:
    """Return the last possible arrival of a case, s."""
    if match := _MAP.match(path.stem):
        return float(match[2])
    try:
        return float(_burned(path)[2].max(initial=0.0))
    except InputError:
        return 0.0


def _cases(files: list[Path]) -> dict[str, Path]:
    """Return the file of each case: the last arrival map, else the list."""
    found: dict[str, tuple[int, Path]] = {}
    for path in files:
        if match := _MAP.match(path.stem):
            case, order = match[1], int(match[2])
        elif (match := _LIST.match(path.stem)) and path.suffix == ".bin":
            case, order = match[2], -1
        else:
            continue
        if case not in found or order > found[case][0]:
            found[case] = order, path
    return {case: path for case, (_, path) in sorted(found.items())}


def _bands(cases: dict[str, Path]) -> set[str]:
    return {match[1] for path in cases.values() if (match := _LIST.match(path.stem))}


def _statistics(path: Path) -> dict[str, dict[str, str]]:
    """Read weather band and ignition of each case; columns are known by their names."""
    with reading(path):
        check_text_size(path)
        with path.open(encoding="utf-8", newline="") as file:
            rows = [[word.strip() for word in row] for row in csv.reader(file) if row]
    names = [name.lower() for name in rows[0]] if rows else []
    at = {key: next((i for i, name in enumerate(names) if name.startswith(key)), -1) for key in _COLUMNS}
    if min(at.values()) < 0:
        raise input_error(path, f"has no columns {', '.join(_COLUMNS)}", line=1)
    found = {}
    for number, row in enumerate(rows[1:], 2):
        try:
            case = f"{int(row[at['icase']]):07}"
            found[case] = {
                "ignition": f"{float(row[at['x']])} {float(row[at['y']])}",
                "band": row[at["meteorology"]],
            }
        except (ValueError, IndexError):
            raise input_error(path, "has a case without the numbers icase, x and y", line=number) from None
    return found


def _any_raster(files: list[Path], path: Path) -> raster.Raster:
    """Read a raster of the inputs.

    Raises
    ------
    InputError
        There is none.
    """
    for each in files:
        if raster.is_raster(each):
            return raster.read(each)
    raise input_error(path, "lists cells of a grid; give a raster of the inputs, such as fbfm40.tif, too")
