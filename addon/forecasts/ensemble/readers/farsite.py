"""Reader of FARSITE or FlamMap: a folder of rasters of arrival times, in minutes, one for each simulation.

The name of such a raster ends with "Arrival Time" or "ArrivalTime". Folders of one simulation each are read
by `folders`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ....errors import InputError
from ....run.models import from_arrival_time, probability_maps, raster
from ....run.models.model import Options
from .. import write
from ..manifest import Manifest, Member
from ..member_set import MemberSet
from . import rasters
from .files_in import add_member, files_in

NAME, ORDER = "FARSITE or FlamMap", 90

_MINUTE = 60.0
_NAME = re.compile(r"[ _-]*arrival[ _]?time$", re.IGNORECASE)


def sniff(paths: list[Path]) -> bool:
    """Check for several rasters of arrival times."""
    return len(_maps(paths)) > 1


def read(paths: list[Path], options: Options, horizon: float) -> MemberSet:
    """Read one member for each raster."""
    maps = _maps(paths)
    opened, good = rasters.open_members(maps, paths[0])
    first = good[0]
    grid, note = first.grid(options.projection, options.at)
    last = max(float(np.nanmax(each.values, initial=0.0)) for each in good) * _MINUTE
    head = Manifest(
        name=options.name or first.path.parent.name,
        model=NAME,
        issued=from_arrival_time.begun(options, first.path),
        horizon=horizon or max(_MINUTE, last),
        members=(),
        zone=options.zone,
        source=f"{len(maps)} rasters of {NAME}",
    )
    notes = ["arrival times are in minutes", *([note] if note else [])]
    return MemberSet(head, grid, _members(opened, head.horizon), notes)


def _members(opened: rasters.Opened, horizon: float) -> Iterator[write.Read]:
    for name, read in opened.items():
        if isinstance(read, InputError):
            yield Member(name), read
            continue
        seconds = np.where(read.values >= 0.0, read.values * np.float32(_MINUTE), np.float32(np.inf))
        seconds[seconds > horizon] = np.inf
        yield Member(name), seconds if np.isfinite(seconds).any() else "nothing burns"


def _maps(paths: list[Path]) -> dict[str, Path]:
    """Return the raster of each simulation, by its name."""
    found: dict[str, Path] = {}
    for path in files_in(paths):
        if _NAME.search(path.stem) and not probability_maps.refusal(path) and raster.is_raster(path):
            add_member(found, _NAME.sub("", path.stem) or path.stem, path)
    return found
