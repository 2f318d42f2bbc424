"""Reader of the Cell2Fire family (Cell2Fire, C2F+K, C2F-W): ``Messages/MessagesFile<simulation>.csv``.

A line is a message of fire from one cell to another: from, to, minutes, m/min. Cells count from 1 by rows
from the north-west corner, the earliest message to a cell is its arrival, and the ignition cell is only in
``ignition_and_weather_log.csv`` (fire2a/C2F-W, Cell2Fire.cpp and DataGenerator.cpp). The results have no
grid; the fuels (``fuels.asc`` or ``fuels.tif``), which are inputs of the model, have the same one.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....errors import input_error, reading
from ....files import check_text_size
from ....run.models import raster
from ....run.models.model import Options
from .. import write
from ..manifest import Member
from ..member_set import MemberSet, burned, describe
from .files_in import files_in, read_table

NAME, ORDER = "Cell2Fire", 20

_MESSAGES = re.compile(r"MessagesFile(\d+)\.csv$")
_LOG = "ignition_and_weather_log.csv"
_COLUMNS = "simulation", "ignition"


def sniff(paths: list[Path]) -> bool:
    """Check for message files."""
    return _results(paths) is not None


def read(paths: list[Path], options: Options, horizon: float) -> MemberSet:
    """Read one member for each simulation."""
    folder = _results(paths)
    assert folder is not None
    fuels = _fuels(paths, folder)
    grid, note = fuels.grid(options.projection, options.at)
    messages = _messages(folder)
    log = _ignitions(folder / _LOG)
    ends = (float(_lines(path)[:, 2].max(initial=0.0)) * 60.0 for path in messages.values())
    horizon = horizon or max(60.0, *ends)
    source = f"{NAME}, {len(messages)} simulations of {folder.name}"
    head, notes = describe(options, folder, NAME, horizon, source, len(set(log.values())))
    notes = ["minutes of messages are arrival times; rows are from the north", note, *notes]
    members = burned(_members(messages, log, folder / _LOG, grid.shape), horizon)
    return MemberSet(head, grid, members, notes)


def _members(
    messages: dict[int, Path], log: dict[int, int], path: Path, shape: tuple[int, int]
) -> Iterator[write.Read]:
    for number, file in messages.items():
        values = _arrival(file, log[number], shape) if number in log else f"has no ignition in {path.name}"
        yield Member(f"{number:03}"), values


def _arrival(path: Path, ignition: int, shape: tuple[int, int]) -> NDArray[np.float64]:
    """Return the arrival times (ny, nx), s, of one simulation."""
    lines = _lines(path)
    cells = np.concatenate([[ignition], lines[:, 1]]).astype(np.int64)
    seconds = np.concatenate([[0.0], lines[:, 2] * 60.0])
    if (cells < 1).any() or (cells > shape[0] * shape[1]).any():
        reason = f"names cell {cells.max()}, and the fuels have {shape[0]} x {shape[1]} cells; give its fuels"
        raise input_error(path, reason)
    arrival = np.full(shape[0] * shape[1], np.inf)
    np.minimum.at(arrival, cells - 1, seconds)
    return arrival.reshape(shape)


def _lines(path: Path) -> NDArray[np.float64]:
    """Read messages (n, 4); none of a fire that did not spread.

    Raises
    ------
    InputError
        A line has other than four numbers.
    """
    with reading(path):
        check_text_size(path)
        lines = list(csv.reader(path.read_text(encoding="ascii", errors="replace").splitlines()))
    rows = []
    for number, line in enumerate(lines, 1):
        try:
            rows.append([float(word) for word in line])
        except ValueError:
            rows.append([])
        if len(rows[-1]) != 4 or not np.isfinite(rows[-1]).all() or rows[-1][2] < 0.0:
            raise input_error(path, "is not a message: write from, to, minutes and m/min", line=number)
    return np.array(rows, np.float64).reshape(-1, 4)


def _ignitions(path: Path) -> dict[int, int]:
    """Read the ignition cell of each simulation."""
    with reading(path):
        return {int(simulation): int(cell) for _, (simulation, cell) in read_table(path, _COLUMNS)}


def _messages(folder: Path) -> dict[int, Path]:
    """Return the message file of each simulation, by its number."""
    matches = {path: _MESSAGES.match(path.name) for path in (folder / "Messages").iterdir()}
    return dict(sorted((int(match[1]), path) for path, match in matches.items() if match))


def _results(paths: list[Path]) -> Path | None:
    """Return the results folder among the paths."""
    for path in paths:
        for folder in (path, path.parent):
            if (folder / "Messages").is_dir() and (folder / _LOG).is_file() and _messages(folder):
                return folder
    return None


def _fuels(paths: list[Path], folder: Path) -> raster.Raster:
    """Read the fuels, which have the grid of the results.

    Raises
    ------
    InputError
        They are not among the paths.
    """
    for path in files_in(paths):
        if path.stem.lower() in ("fuels", "forest") and raster.is_raster(path):
            return raster.read(path)
    raise input_error(folder, "has no grid; give the model's fuels.asc or fuels.tif too")
