"""Reader of a folder for each member, with output of a fire model: WRF-SFIRE, FARSITE, ForeFire and others.

Each folder is read as `firetwin convert` reads it; heat and weather are not computed.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....errors import Error, InputError, input_error
from ....run import readers as runs
from ....run.models.grid import Placed
from ....run.models.model import Model, Options
from .. import write
from ..manifest import Member
from ..member_set import MemberSet, attempt, burned, check_start, describe

NAME, ORDER = "a folder for each member", 100

_TOLERANCE = 0.01  # of a cell


def sniff(paths: list[Path]) -> bool:
    """Check for at least two folders with output of a fire model."""
    return len(_folders(paths)) > 1


def read(paths: list[Path], options: Options, horizon: float) -> MemberSet:
    """Read one member for each folder."""
    folders = _folders(paths)
    opened = {folder: attempt(_model, folder, options) for folder in folders}
    models = {folder: model for folder, model in opened.items() if isinstance(model, Model)}
    if not models:
        raise input_error(paths[0], f"none of its {len(folders)} folders can be read; {opened[folders[0]]}")
    first_folder, first = next(iter(models.items()))
    horizon = horizon or max(_end(model) or float(model.times[-1]) for model in models.values())
    started = replace(options, start=first.start)
    source = f"{len(folders)} folders of {first.source}"
    head, _ = describe(started, paths[0], first.source, horizon, source)
    notes = [f"{first_folder.name}: {text}" for text in first.assumptions]
    members = burned(_members(opened, first_folder, first), math.inf)
    return MemberSet(head, first.fuel_grid, members, notes)


def _members(
    opened: dict[Path, Model | InputError], first_folder: Path, first: Model
) -> Iterator[write.Read]:
    """Read arrival times on the grid of the first model, which the caller resamples."""
    placed = first.fuel_grid.placed
    for folder, model in opened.items():
        if isinstance(model, InputError):
            yield Member(folder.name), model
            continue
        with closing(model):
            check_start(folder, model.start, first_folder, first.start)
            _check_cells(folder, model, first_folder, placed)
            arrival = attempt(model.still.get("fuel_arrival_time", lambda: "has no arrival times"))
        member = Member(folder.name, end=_end(model) or math.inf)
        yield member, arrival if isinstance(arrival, str | InputError) else np.asarray(arrival, np.float32)


def _model(folder: Path, options: Options) -> Model:
    """Open a folder as a model."""
    try:
        files = runs.gathered([folder])
        return runs.reader(files).read(files, replace(options, name=""))
    except InputError:
        raise
    except Error as error:
        raise input_error(folder, str(error)) from None


def _end(model: Model) -> float:
    """Return the end of the simulation, s; 0 if its files do not give it, as for maps of arrival times."""
    return float(model.times[-1]) if "burned_fraction" in model.moving else 0.0


def _check_cells(folder: Path, model: Model, first_folder: Path, placed: Placed) -> None:
    theirs = model.fuel_grid.placed
    if theirs.shape != placed.shape or not (
        _same(theirs.latitude, placed.latitude) and _same(theirs.longitude, placed.longitude)
    ):
        reason = f"has other cells than {first_folder.name}"
        raise input_error(
            folder, f"{reason}; convert each folder to a run, and list the runs in ensemble.toml"
        )


def _same(one: NDArray[np.float64], other: NDArray[np.float64]) -> bool:
    step = np.abs(np.diff(other)).min() if len(other) > 1 else 1e-6
    return bool(np.abs(one - other).max() <= _TOLERANCE * step)


def _folders(paths: list[Path]) -> list[Path]:
    """Return the folders with output of a model among the paths, or in the only path."""
    inside = sorted(paths[0].iterdir()) if len(paths) == 1 and paths[0].is_dir() else paths
    return [each for each in inside if each.is_dir() and each.name[0] != "." and runs.foreign(each)]
