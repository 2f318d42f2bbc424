"""Reader of FARSITE or FlamMap: a folder of rasters of arrival times, in minutes, one for each simulation.

The name of such a raster ends with "Arrival Time" or "ArrivalTime". Folders of one simulation each are read
by `folders`.
"""

from __future__ import annotations

import re
from pathlib import Path

from ....run.models import probability_maps, raster
from ....run.models.model import Options
from ....run.readers import farsite as run_reader
from ..member_set import MemberSet
from . import rasters
from .files_in import add_member, files_in

NAME, ORDER = "FARSITE or FlamMap", 90

_NAME = re.compile(r"[ _-]*arrival[ _]?time$", re.IGNORECASE)


def sniff(paths: list[Path]) -> bool:
    """Check for several rasters of arrival times."""
    return len(_maps(paths)) > 1


def read(paths: list[Path], options: Options, horizon: float) -> MemberSet:
    """Read one member for each raster."""
    maps = _maps(paths)
    source = f"{len(maps)} rasters of {NAME}"
    members = rasters.read_members(maps, run_reader.MINUTE, NAME, options, horizon, source)
    members.notes.insert(0, "arrival times are in minutes")
    return members


def _maps(paths: list[Path]) -> dict[str, Path]:
    """Return the raster of each simulation, by its name."""
    maps: dict[str, Path] = {}
    for path in files_in(paths):
        if _NAME.search(path.stem) and not probability_maps.refusal(path) and raster.is_raster(path):
            add_member(maps, _NAME.sub("", path.stem) or path.stem, path)
    return maps
