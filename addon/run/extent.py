"""Extent of the largest of several fires."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..geometry.grids import label

_BLOCKS = 96  # blocks along the longer side; patches less than a block apart are one fire


def largest(burned: NDArray[np.bool_], cell: tuple[float, float]) -> float:
    """Compute the diagonal (m) of the fire with the most cells among `burned` (ny, nx); 0 without fire.

    Parameters
    ----------
    cell
        Height and width of a cell, m.
    """
    row, column = np.nonzero(burned)
    if len(row) == 0:
        return 0.0
    size = -(-max(np.ptp(row) + 1, np.ptp(column) + 1) // _BLOCKS)
    block = (row - row.min()) // size, (column - column.min()) // size
    blocks = np.zeros((_BLOCKS, _BLOCKS), np.bool_)
    blocks[block] = True
    fire = label(blocks)[0][block]
    most = fire == np.argmax(np.bincount(fire))
    return float(np.hypot((np.ptp(row[most]) + 1) * cell[0], (np.ptp(column[most]) + 1) * cell[1]))
