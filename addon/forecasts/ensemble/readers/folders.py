"""Reader of a folder for each member, with output of a fire model: WRF-SFIRE, FARSITE, ForeFire and others.

Each folder is read as `firetwin convert` reads it; heat and weather are not computed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....errors import Error, InputError, input_error
from ....run import readers as runs
from ....run.models.grid import Placed
from ....run.models.model import Model, Options
from .. import write
from ..manifest import Manifest, Member
from ..member_set import MemberSet

NAME, ORDER = "a folder for each member", 100

_TOLERANCE = 0.01  # of a cell


def sniff(paths: list[Path]) -> bool:
    """Check for at least two folders with output of a fire model."""
    return len(_folders(paths)) > 1


def read(paths: list[Path], options: Options, horizon: float) -> MemberSet:
    """Read one member for each folder."""
    folders = _folders(paths)
    opened = [(folder, _model(folder, options)) for folder in folders]
    models = [(folder, model) for folder, model in opened if isinstance(model, Model)]
    if not models:
        raise input_error(paths[0], f"none of its {len(folders)} folders can be read; {opened[0][1]}")
    first_folder, first = models[0]
    head = Manifest(
        name=options.name or paths[0].name,
        model=first.source,
        issued=first.start,
        horizon=horizon or max(_end(model) or float(model.times[-1]) for _, model in models),
        members=(),
        zone=options.zone,
        source=f"{len(folders)} folders of {first.source}",
    )
    notes = [f"{first_folder.name}: {text}" for text in first.assumptions]
    return MemberSet(head, first.fuel_grid, _members(opened, first_folder, first), notes)


def _members(
    opened: list[tuple[Path, Model | InputError]], first_folder: Path, first: Model
) -> Iterator[write.Read]:
    """Read arrival times on the grid of the first model, which the caller resamples."""
    placed = first.fuel_grid.placed
    for folder, model in opened:
        member = Member(folder.name)
        if isinstance(model, InputError):
            yield member, model
            continue
        try:
            _check(folder, model, first_folder, first.start, placed)
            arrival = model.still.get("fuel_arrival_time", lambda: None)()
        except InputError as error:
            if error.path == str(folder):
                raise
            yield member, error
            continue
        finally:
            model.close()
        if arrival is None:
            yield member, "has no arrival times"
            continue
        values = np.asarray(arrival, np.float32)
        end = _end(model)
        member = replace(member, end=end) if end else member
        yield (
            member,
            np.where(np.isnan(values), np.inf, values) if np.isfinite(values).any() else "nothing burns",
        )


def _model(folder: Path, options: Options) -> Model | InputError:
    """Open a folder as a model; a reader that cannot is the reason why the member is left out."""
    try:
        files = runs.gathered([folder])
        return runs.reader(files).read(files, replace(options, name=""))
    except InputError as error:
        return error
    except Error as error:
        return input_error(folder, str(error))


def _end(model: Model) -> float:
    """Return the end of the simulation, s; 0 if its files do not give it, as for maps of arrival times."""
    return float(model.times[-1]) if "burned_fraction" in model.moving else 0.0


def _check(folder: Path, model: Model, first_folder: Path, start: datetime, placed: Placed) -> None:
    """Check that a member has the start and the grid of the first one.

    Raises
    ------
    InputError
        It has not; the error's path is the folder.
    """
    shift = (model.start - start).total_seconds()
    if abs(shift) > 0.5:
        raise input_error(
            folder, f"begins {shift / 3600.0:+.2f} h from {first_folder.name}; members have one start"
        )
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
