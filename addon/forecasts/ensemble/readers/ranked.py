"""Reader of ranks of fire size by elmfire_post, as Pyrecast shows them: ``time-of-arrival_<percentile>.tif``.

elmfire_post sorts the cases by their final area: percentile P of N is the case of rank 0.01 P N
(elmfire_post.f90). Each raster is one case, with arrival times in hours, and 0, which is also no data, in
other cells. Pyrecast stores it as ``<date>_<time>/elmfire/landfire/<percentile>/time-of-arrival.tif``, UTC.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from ....errors import InputError
from ....run.models import from_arrival_time, raster
from ....run.models.model import Options
from .. import write
from ..manifest import Manifest, Member
from ..member_set import MemberSet
from . import rasters
from .files_in import files_in

NAME, ORDER = "ranks of fire size (elmfire_post, Pyrecast)", 50

_HOUR = 3600.0
_MAP = re.compile(r"time-of-arrival_(\d\d)$")
_FOLDER = re.compile(r"\d\d$")
_MOMENT = re.compile(r"(\d{8})_(\d{6})(?!\d)")


def sniff(paths: list[Path]) -> bool:
    """Check for rasters of arrival times of percentiles."""
    return bool(_maps(paths))


def read(paths: list[Path], options: Options, horizon: float) -> MemberSet:
    """Read one member for each percentile."""
    maps = _maps(paths)
    opened, good = rasters.open_members(maps, paths[0])
    first = good[0].path
    grid, note = good[0].grid(options.projection, options.at)
    told = options if options.start else replace(options, start=_moment(first))
    notes = [
        "each member stands for a rank of fire size, so that their shares are not a probability",
        "arrival times are in hours; cells that burned before the start are not in these maps",
        *([note] if note else []),
    ]
    if told.start and not options.start:
        notes.append("issue time is the folder's name, in UTC")
    last = max(float(np.nanmax(each.values, initial=0.0)) for each in good) * _HOUR
    head = Manifest(
        name=options.name or first.parent.name,
        model="ELMFIRE",
        issued=from_arrival_time.begun(told, first),
        horizon=horizon or max(_HOUR, last),
        members=(),
        zone=options.zone,
        source=f"{len(maps)} {NAME}",
        kind="ranked",
    )
    return MemberSet(head, grid, _members(opened, head.horizon), notes)


def _members(opened: rasters.Opened, horizon: float) -> Iterator[write.Read]:
    for percentile, read in opened.items():
        member = Member(f"size percentile {percentile}")
        if isinstance(read, InputError):
            yield member, read
            continue
        arrival = np.where(read.values > 0.0, read.values * _HOUR, np.inf).astype(np.float32)
        arrival[arrival > horizon] = np.inf
        yield member, arrival if np.isfinite(arrival).any() else "nothing burns"


def _maps(paths: list[Path]) -> dict[str, Path]:
    """Return the raster of each percentile."""
    folders = [each for path in paths if path.is_dir() for each in sorted(path.iterdir())]
    inner = [each for each in folders if each.is_dir() and _FOLDER.fullmatch(each.name)]
    found: dict[str, Path] = {}
    for path in files_in([*paths, *inner]):
        match = _MAP.match(path.stem)
        percentile = match[1] if match else path.parent.name
        if (match or path.stem == "time-of-arrival") and _FOLDER.fullmatch(percentile):
            found |= {percentile: path} if raster.is_raster(path) else {}
    return dict(sorted(found.items()))


def _moment(path: Path) -> datetime | None:
    """Return the time in the name of a folder above the file, UTC; None without one."""
    for name in reversed(path.absolute().parts[:-1]):
        if match := _MOMENT.search(name):
            try:
                return datetime.strptime("".join(match.groups()), "%Y%m%d%H%M%S").replace(tzinfo=UTC)
            except ValueError:
                continue
    return None
