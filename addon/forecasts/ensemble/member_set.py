"""Members of a forecast as a reader of a model's files supplies them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import ParamSpec, TypeVar

import numpy as np

from ...errors import Error, InputError, input_error
from ...run.models import from_arrival_time
from ...run.models.grid import Grid
from ...run.models.model import Options
from . import write
from .ignitions import Ignitions
from .manifest import Manifest

Arguments = ParamSpec("Arguments")
Value = TypeVar("Value")


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
        Assumptions, in sentences; empty ones are ignored.
    """

    head: Manifest
    grid: Grid
    members: Iterator[write.Read]
    notes: list[str] = field(default_factory=list)


def describe(
    options: Options, path: Path, model: str, horizon: float, source: str, ignitions: int = 1
) -> tuple[Manifest, list[str]]:
    """Describe the members of a model's files: a manifest without members, and notes on it.

    Parameters
    ----------
    path
        A file, or the folder, of the members: its folder is the name unless the options have one.
    horizon
        Length of the forecast, s.
    ignitions
        Number of different ignitions of the members.

    Raises
    ------
    InputError
        The options have no start.
    """
    head = Manifest(
        name=options.name or (path if path.is_dir() else path.parent).name,
        model=model,
        issued=from_arrival_time.begun(options, path),
        horizon=horizon,
        members=(),
        zone=options.zone,
        source=source,
        kind="ignitions" if ignitions > 1 else "forecast",
    )
    note = f"the members have {ignitions} ignitions, so they do not forecast one fire"
    return head, [note] if ignitions > 1 else []


def attempt(
    read: Callable[Arguments, Value], *args: Arguments.args, **kwargs: Arguments.kwargs
) -> Value | InputError:
    """Call a function that reads a member, and return its error if the files are damaged."""
    try:
        return read(*args, **kwargs)
    except InputError as error:
        return error


def check_start(folder: Path, start: datetime, first_folder: Path, first: datetime) -> None:
    """Check that a member has the start of the first one.

    Raises
    ------
    InputError
        It has not; the error's path is the folder.
    """
    shift = (start - first).total_seconds()
    if abs(shift) > 0.5:
        reason = f"begins {shift / 3600.0:+.2f} h from {first_folder.name}; members have one start"
        raise input_error(folder, reason)


def burned(members: Iterable[write.Read], horizon: float) -> Iterator[write.Read]:
    """Limit arrival times to the horizon (s), inf for later ones and NaN; leave out members without any."""
    for member, values in members:
        if isinstance(values, np.ndarray):
            values = np.where(values <= horizon, values, np.inf).astype(np.float32)
            yield member, values if np.isfinite(values).any() else "nothing burns"
        else:
            yield member, values


def save(members: MemberSet, out: Path, source: Path) -> Manifest:
    """Write members to the folder `out` (see `write.write`), on the axes of a run.

    Raises
    ------
    InputError
        The grid is invalid, or see `write.write`; `source` is the file that the message names.
    """
    try:
        placed = members.grid.placed
    except Error as error:
        raise input_error(source, str(error)) from None
    if placed.error:
        members.notes.append(placed.error)
    arrivals = (
        (member, placed.put(values, np.nan) if isinstance(values, np.ndarray) else values)
        for member, values in members.members
    )
    ignitions = Ignitions(placed.latitude, placed.longitude)
    amend = partial(ignitions.amend, tell=members.notes.append)
    return write.write(out, members.head, placed.latitude, placed.longitude, ignitions.watch(arrivals), amend)
