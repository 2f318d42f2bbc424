"""Revisions of a growing run: run folders with one more time each, published by one rename.

Files of earlier times and constant fields are hard links to the same files of the revision before.
"""

from __future__ import annotations

import contextlib
import hashlib
import re
from dataclasses import replace
from datetime import datetime
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .. import files
from ..errors import InputError, input_error, reading
from ..run import opening
from ..run.models import netcdf, write
from ..run.models.model import Model
from ..staging import new_folder
from ..unfinished import rests
from . import watched
from .watched import Accepted

_KEPT = 2  # revisions of a generation that stay, as a reader may have the last but one open
_NAME = r"\d{6,}"
"""Names of revisions."""
_ARRIVAL = "fuel_arrival_time"

Fields = dict[str, NDArray[np.float32]]


class UnwrittenError(Exception):
    """A time has values that the model has not written yet."""


def read_time(model: Model, index: int) -> Fields:
    """Read the horizontal fields of a time, on the run's grids.

    Raises
    ------
    UnwrittenError
        A field has a fill value of netCDF, which a model never writes.
    InputError
        The file cannot be read.
    """
    fields: Fields = {}
    for name, get in model.moving.items():
        if name in model.levels:
            continue
        with reading(model.sources[index][0]):
            values = get(index)
        if (np.abs(np.nan_to_num(np.asarray(values, np.float64))) >= netcdf.UNWRITTEN).any():
            raise UnwrittenError(name)
        fields[name] = write.on_run_grid(model, name, values)
    return fields


def digest(fields: Fields) -> str:
    """Hash the values of a time (SHA-256)."""
    hashed = hashlib.sha256()
    for name in sorted(fields):
        hashed.update(name.encode())
        hashed.update(np.ascontiguousarray(fields[name], "<f4").tobytes())
    return hashed.hexdigest()


def publish(
    folder: Path, model: Model, before: list[Accepted], new: list[Accepted], values: list[Fields], inputs: str
) -> Path:
    """Write the run of all accepted times of a generation, and return its folder.

    Parameters
    ----------
    model
        Model whose times end with the last accepted one.
    before, new
        Accepted times of the generation: in the revision before, and the others.
    values
        Fields of the times of `new`.
    inputs
        Text of the inputs for ``run.toml``.

    Raises
    ------
    InputError
        The disk is full, or the fields make no run.
    """
    target = watched.revision_folder(folder, new[-1].generation, new[-1].revision)
    last = watched.revision_folder(folder, before[-1].generation, before[-1].revision) if before else None
    watched.refuse_link(target.parent)
    with new_folder(target) as part:
        _times(part, last, len(before), values, model.files[0])
        _constants(part, last, model, new[-1].moment)
        seconds = np.array([each.seconds for each in (*before, *new)])
        files.write_text(part / "run.toml", write.description(replace(model, times=seconds), inputs))
        _check(part, model)
        _remove(target)  # left by a watch that was killed
    return target


def remove_old(folder: Path, generation: int) -> None:
    """Remove revisions of a generation except the last ones."""
    parent = watched.revision_folder(folder, generation, 0).parent
    if parent.is_symlink():
        return
    every = sorted(each for each in parent.glob("[0-9]*") if re.fullmatch(_NAME, each.name))
    for old in every[:-_KEPT]:
        _remove(old)


def _remove(revision: Path) -> None:
    """Remove the files of a revision, and its folders if they are then empty; files of others stay."""
    if revision.is_symlink() or not revision.is_dir():
        return
    with contextlib.suppress(OSError):
        fields = [each for each in revision.iterdir() if each.is_dir() and not each.is_symlink()]
        for path in [each for folder in (revision, *fields) for each in folder.iterdir()]:
            if path.name == "run.toml" or path.suffix == ".npy":
                path.unlink()
        for folder in (*fields, revision):
            with contextlib.suppress(OSError):
                folder.rmdir()


def _times(part: Path, last: Path | None, count: int, values: list[Fields], source: Path) -> None:
    """Link the files of earlier times, and write the new ones."""
    names = sorted(values[0])
    if last is not None:
        known = sorted(each.name for each in last.iterdir() if each.is_dir())
        if known != names:
            raise input_error(source, f"has the fields {', '.join(names)}, and before {', '.join(known)}")
    for name in names:
        (part / name).mkdir()
        for index in range(count):
            assert last is not None
            files.link_or_copy(last / name / f"{index:06d}.npy", part / name / f"{index:06d}.npy")
        for index, fields in enumerate(values, start=count):
            path = part / name / f"{index:06d}.npy"
            files.write(path, lambda to, array=fields[name]: np.save(to, array))  # type: ignore[misc]


def _constants(part: Path, last: Path | None, model: Model, until: datetime) -> None:
    """Link the constant fields, or write them in a first revision; arrival times are always written."""
    if last is not None:
        for each in last.glob("*.npy"):
            if each.stem != _ARRIVAL:
                files.link_or_copy(each, part / each.name)
    for name, get in model.still.items():
        if last is not None and name != _ARRIVAL:
            continue
        where = model.grid_of(name).placed
        with reading(model.files[0]):
            values = where.put(get(), write.FILL.get(name))
        if name == _ARRIVAL:
            values = np.asarray(values, np.float64)
            end = (until - model.start).total_seconds()
            values = np.where(values <= end, values, np.nan)
        files.write(part / f"{name}.npy", lambda to, array=values: np.save(to, array))  # type: ignore[misc]
    if last is None:
        for before, grid in model.grids.items():
            for axis in ("latitude", "longitude"):
                array = getattr(grid.placed, axis)
                files.write(part / f"{before}{axis}.npy", lambda to, array=array: np.save(to, array))  # type: ignore[misc]


def _check(part: Path, model: Model) -> None:
    """Open the new run as a check."""
    try:
        opening.open(part)
    except InputError as error:
        reason = f"makes no run: {Path(error.path).stem}: {error.reason}; it is most likely incomplete"
        raise input_error(model.files[0], reason) from None


def remove_parts(folder: Path) -> None:
    """Remove temporary folders of a killed watch."""
    for each in folder.glob("generation_*"):
        if not each.is_symlink():
            rests(each, _NAME)
