"""Gather runs as members of an ensemble: a list of runs in ``ensemble.toml``, or the folders in a folder."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import datetime
from functools import partial
from pathlib import Path

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ...errors import Error, InputError, input_error
from ...progress import MessageCallback, no_message
from ...run import readers, times
from ...run.arrival_grid import ArrivalGrid
from . import manifest, write
from .ignitions import Ignitions
from .manifest import MANIFEST, Manifest, Member

_TOLERANCE = 0.01  # of a cell: shift between grids that counts as the same grid


def sniff(path: Path) -> bool:
    """Check for a list of runs, or a folder of run folders."""
    if path.is_file():
        return path.suffix == ".toml"
    return (path / MANIFEST).is_file() or any(readers.folder.sniff(each) for each in path.iterdir())


def listed(path: Path) -> Manifest:
    """Return the list of runs at a path: a file ``ensemble.toml``, or a folder of run folders.

    Raises
    ------
    InputError
        The file is damaged, or the folder has no runs.
    """
    if path.is_file():
        listing = manifest.read(path)
        if missing := next((member.name for member in listing.members if member.run is None), None):
            raise input_error(path, f'member "{missing}" has no run; write run = "FOLDER"')
        return _absolute(listing, path.parent)
    if (path / MANIFEST).is_file():
        return listed(path / MANIFEST)
    runs = sorted(each for each in path.iterdir() if each.is_dir() and not each.name.startswith("."))
    runs = [each for each in runs if readers.folder.sniff(each)]
    if not runs:
        raise input_error(
            path, f"has no runs; give a folder of run folders, or a file {MANIFEST} that lists them"
        )
    members = tuple(Member(each.name, run=each) for each in runs)
    return Manifest(path.name, "", None, 0.0, members, source=f"{len(runs)} runs")


def convert(path: Path, out: Path, horizon: float = 0.0, tell: MessageCallback = no_message) -> Manifest:
    """Write an ensemble of the runs at `path` (see `listed`) to the folder `out`, and return its manifest.

    Parameters
    ----------
    horizon
        Length of the forecast, s; 0: of the manifest, else of the longest member.

    Raises
    ------
    InputError
        No run can be opened, or their starts or grids differ.
    """
    listing = listed(path)
    outlined = [(member, _outline(member)) for member in listing.members]
    outlines = {member.name: each for member, each in outlined if isinstance(each, _Outline)}
    if not outlines:
        raise input_error(path, f"none of its {len(outlined)} runs can be read; {outlined[0][1]}")
    latitude, longitude = _union(path, outlines)
    first = next(iter(outlines))
    issued = listing.issued or outlines[first].begin
    head = replace(
        listing,
        issued=issued,
        horizon=horizon or listing.horizon,
        model=listing.model,
        synthetic=listing.synthetic or any(each.synthetic for each in outlines.values()),
        source=listing.source or f"{len(outlined)} runs",
    )

    def members() -> Iterator[write.Read]:
        for member, outline in outlined:
            if isinstance(outline, InputError):
                yield member, outline
                continue
            run = _open(member)
            if isinstance(run, InputError):
                yield member, run
                continue
            shift = (outline.begin - issued).total_seconds()
            if listing.issued is None and abs(shift) > 0.5:
                reason = f"begins {shift / 3600.0:+.2f} h from {first}; members have one start"
                raise input_error(Path(run.path), f"{reason}; write issued = TIME in {MANIFEST} to accept it")
            end = min(member.end, outline.last + shift)
            grid = ArrivalGrid.from_run(run)
            yield replace(member, end=end), _placed(grid, shift, end, latitude, longitude)

    if path.is_file() or (path / MANIFEST).is_file():  # the list gives the kind
        return write.write(out, head, latitude, longitude, members())
    ignitions = Ignitions(latitude, longitude)
    amend = partial(ignitions.amend, tell=tell)
    return write.write(out, head, latitude, longitude, ignitions.watch(members()), amend)


def _absolute(listing: Manifest, folder: Path) -> Manifest:
    """Resolve run folders against the folder of the manifest."""
    members = [replace(each, run=(folder / each.run).absolute()) for each in listing.members if each.run]
    return replace(listing, members=tuple(members))


@dataclass(frozen=True)
class _Outline:
    """Cell centres (degrees, ascending), start (UTC) and last time (s) of a run."""

    latitude: NDArray[np.float64]
    longitude: NDArray[np.float64]
    begin: datetime
    last: float
    synthetic: bool


def _outline(member: Member) -> _Outline | InputError:
    """Outline a run, which is closed again: a process may open fewer files than an ensemble has."""
    run = _open(member)
    if isinstance(run, InputError):
        return run
    axes = np.sort(run.fuel_latitude), np.sort(run.fuel_longitude)
    return _Outline(*axes, times.utc(run, 0.0), float(run.times[-1]), run.synthetic)


def _open(member: Member) -> Run | InputError:
    assert member.run is not None
    try:
        return readers.open(member.run)
    except InputError as error:
        return error


def _placed(
    grid: ArrivalGrid, shift: float, end: float, latitude: NDArray[np.float64], longitude: NDArray[np.float64]
) -> NDArray[np.float32] | str:
    """Place arrival times on the common grid, s since the issue time; NaN outside of the grid of the run."""
    arrival = grid.arrival + shift
    arrival = np.where(arrival <= end, arrival, np.inf)  # also NaN: the run's word for never
    if not (arrival < math.inf).any():
        return "nothing burns"
    result = np.full((len(latitude), len(longitude)), np.nan, np.float32)
    row, column = _first(grid.latitude, latitude), _first(grid.longitude, longitude)
    result[row : row + len(grid.latitude), column : column + len(grid.longitude)] = arrival
    return result


def _first(axis: NDArray[np.float64], common: NDArray[np.float64]) -> int:
    return int(np.abs(common - axis[0]).argmin())


def _union(path: Path, outlines: dict[str, _Outline]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return axes that contain all grids.

    Raises
    ------
    InputError
        Cells of two grids differ in size or position by more than 1 % of a cell.
    """
    unions = []
    for name in ("latitude", "longitude"):
        axes = {member: getattr(grid, name) for member, grid in outlines.items()}
        try:
            unions.append(_extended(list(axes.values()), list(axes)))
        except Error as error:
            reason = f"{error}; members need cells of one grid: convert them with the same options"
            raise input_error(path, reason) from None
    return unions[0], unions[1]


def _extended(axes: list[NDArray[np.float64]], names: list[str]) -> NDArray[np.float64]:
    """Extend the first axis, which ascends, to all others.

    Raises
    ------
    Error
        An axis has other cells.
    """
    first = axes[0]
    step = float(np.diff(first).mean()) if len(first) > 1 else 1.0
    before = max(0, max(round((first[0] - axis[0]) / step) for axis in axes))
    after = max(0, max(round((axis[-1] - first[-1]) / step) for axis in axes))
    result = np.concatenate(
        [first[0] - step * np.arange(before, 0, -1), first, first[-1] + step * np.arange(1, after + 1)]
    )
    for axis, name in zip(axes, names, strict=True):
        start = _first(axis, result)
        under = result[start : start + len(axis)]
        if len(under) != len(axis) or np.abs(under - axis).max() > _TOLERANCE * step:
            raise Error(f"{name} has other cells than {names[0]}")
    return result
