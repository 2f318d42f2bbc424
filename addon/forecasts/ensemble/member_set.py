"""Members of a forecast as a reader of a model's files supplies them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...errors import Error, input_error
from ...run.models.grid import Grid
from . import write
from .manifest import Manifest


@dataclass
class MemberSet:
    """Members on one grid of a model.

    Attributes
    ----------
    head
        Manifest without members.
    grid
        Grid of the arrival times.
    members
        Each member with its arrival times on the grid, s since the issue time, or the reason why it has none.
    notes
        Assumptions, in sentences.
    """

    head: Manifest
    grid: Grid
    members: Iterator[write.Read]
    notes: list[str] = field(default_factory=list)


def save(found: MemberSet, out: Path, source: Path) -> Manifest:
    """Write members to the folder `out` (see `write.write`), on the axes of a run.

    Raises
    ------
    InputError
        The grid is invalid, or see `write.write`; `source` is the file that the message names.
    """
    try:
        placed = found.grid.placed
    except Error as error:
        raise input_error(source, str(error)) from None
    if placed.error:
        found.notes.append(placed.error)
    members = (
        (member, placed.put(values, np.nan) if isinstance(values, np.ndarray) else values)
        for member, values in found.members
    )
    return write.write(out, found.head, placed.latitude, placed.longitude, members)
