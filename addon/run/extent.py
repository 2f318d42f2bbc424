"""Extent of the largest of several fires."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_BLOCKS = 96  # blocks along the longer side; patches less than a block apart are one fire
_BESIDE = [(row, column) for row in (-1, 0, 1) for column in (-1, 0, 1) if row or column]


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
    blocks, member = np.unique(
        np.stack([row - row.min(), column - column.min()], axis=-1) // size, axis=0, return_inverse=True
    )
    fire = np.array(_joined([tuple(block) for block in blocks.tolist()]))[member.ravel()]
    most = fire == np.argmax(np.bincount(fire))
    return float(np.hypot((np.ptp(row[most]) + 1) * cell[0], (np.ptp(column[most]) + 1) * cell[1]))


def _joined(blocks: list[tuple[int, int]]) -> list[int]:
    """Label connected components: fire number of each block, with adjacent blocks joined."""
    number: dict[tuple[int, int], int] = {}
    known, fire = set(blocks), -1
    for first in blocks:
        if first in number:
            continue
        fire, left = fire + 1, [first]
        number[first] = fire
        while left:
            row, column = left.pop()
            for down, right in _BESIDE:
                beside = (row + down, column + right)
                if beside in known and beside not in number:
                    number[beside] = fire
                    left.append(beside)
    return [number[block] for block in blocks]
