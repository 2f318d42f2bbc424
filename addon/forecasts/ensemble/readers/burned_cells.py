"""Lists of burned cells: columns and rows count from 1, rows from the south; a raster has their grid."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, input_error
from ....run.models import raster
from ..member_set import attempt

Cells = tuple[NDArray, NDArray, NDArray]
"""Columns, rows and arrival times (s) of burned cells (n,)."""


def place(path: Path, cells: Cells, shape: tuple[int, int]) -> NDArray[np.float32]:
    """Place the cells of a list on a grid (ny, nx): s, rows from the north, inf elsewhere.

    Raises
    ------
    InputError
        A cell is outside of the grid, or a time is negative or NaN.
    """
    column, row, seconds = cells
    if not ((column >= 1) & (column <= shape[1]) & (row >= 1) & (row <= shape[0])).all():
        reason = f"has cell ({column.max()}, {row.max()}) where the raster has {shape[1]} x {shape[0]}"
        raise input_error(path, f"{reason}; give a raster of its inputs")
    if not (seconds >= 0.0).all():
        raise input_error(path, "has arrival times that are negative or not numbers; it is damaged")
    values = np.full(shape, np.inf, np.float32)
    np.minimum.at(values, (shape[0] - row, column - 1), seconds)
    return values


def last(read: Callable[[Path], Cells], paths: Iterable[Path]) -> float:
    """Return the last arrival of lists, at least a minute, s; damaged lists have none."""
    lists = [attempt(read, path) for path in paths]
    return max([60.0, *(each[2].max(initial=0.0) for each in lists if not isinstance(each, InputError))])


def read_inputs(files: list[Path], path: Path) -> raster.Raster:
    """Read any raster of the model's inputs, which has the grid of a list.

    Raises
    ------
    InputError
        There is none.
    """
    for each in files:
        if raster.is_raster(each):
            return raster.read(each)
    raise input_error(path, "lists cells of a grid; give a raster of the inputs too, such as dem.tif")
