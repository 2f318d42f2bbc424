"""Reader of ranks of fire size by elmfire_post, as Pyrecast shows them: ``time-of-arrival_<percentile>.tif``.

elmfire_post sorts the cases by their final area: percentile P of N is the case of rank 0.01 P N
(elmfire_post.f90). Each raster is one case, with arrival times in hours, and 0, which is also no data, in
other cells. Pyrecast stores it as ``<date>_<time>/elmfire/landfire/<percentile>/time-of-arrival.tif``, UTC.
"""

from __future__ import annotations

import re
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

from ....run.models import raster
from ....run.models.model import Options
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
    folder_time = None if options.start else _moment(next(iter(maps.values())))
    options = replace(options, start=options.start or folder_time)
    names = {f"size percentile {percentile}": path for percentile, path in maps.items()}
    members = rasters.read_members(names, _HOUR, "ELMFIRE", options, horizon, f"{len(maps)} {NAME}", 0.0)
    members.head = replace(members.head, kind="ranked")
    members.notes[:0] = [
        "each member stands for a rank of fire size, so that their shares are not a probability",
        "arrival times are in hours; cells that burned before the start are not in these maps",
        "issue time is the folder's name, in UTC" if folder_time else "",
    ]
    return members


def _maps(paths: list[Path]) -> dict[str, Path]:
    """Return the raster of each percentile."""
    folders = [each for path in paths if path.is_dir() for each in sorted(path.iterdir())]
    inner = [each for each in folders if each.is_dir() and _FOLDER.fullmatch(each.name)]
    maps: dict[str, Path] = {}
    for path in files_in([*paths, *inner]):
        match = _MAP.match(path.stem)
        percentile = match[1] if match else path.parent.name
        if (match or path.stem == "time-of-arrival") and _FOLDER.fullmatch(percentile):
            maps |= {percentile: path} if raster.is_raster(path) else {}
    return dict(sorted(maps.items()))


def _moment(path: Path) -> datetime | None:
    """Return the time in the name of a folder above the file, UTC; None without one."""
    for name in reversed(path.absolute().parts[:-1]):
        if match := _MOMENT.search(name):
            try:
                return datetime.strptime("".join(match.groups()), "%Y%m%d%H%M%S").replace(tzinfo=UTC)
            except ValueError:
                continue
    return None
