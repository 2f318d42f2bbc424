"""Rasters of arrival times, one for each member: damaged ones are left out, the others need one grid."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....errors import InputError, input_error
from ....run.models import from_arrival_time, raster
from ....run.models.model import Options
from ..manifest import Member
from ..member_set import MemberSet, attempt, burned, describe

Opened = dict[str, raster.Raster | InputError]


def read_members(
    maps: Mapping[str, Path],
    unit: float,
    model: str,
    options: Options,
    horizon: float,
    source: str,
    unburned: float = -1.0,
) -> MemberSet:
    """Read one member for each raster, with arrival times in a unit (s); those up to `unburned` are never.

    Raises
    ------
    InputError
        None can be read, or their cells differ.
    """
    opened, good = _open(maps)
    grid, note = good[0].grid(options.projection, options.at)
    last = max(float(np.nanmax(each.values, initial=0.0)) for each in good) * unit
    head, notes = describe(options, good[0].path, model, horizon or max(unit, last), source)

    def values(read: raster.Raster) -> NDArray:
        seconds = from_arrival_time.arrival_times(read, unit)
        return np.where(seconds > unburned, seconds, np.inf)

    members = (
        (Member(name), values(read) if isinstance(read, raster.Raster) else read)
        for name, read in opened.items()
    )
    return MemberSet(head, grid, burned(members, head.horizon), [*notes, note])


def _open(maps: Mapping[str, Path]) -> tuple[Opened, list[raster.Raster]]:
    """Read all rasters, with the reason for damaged ones, and return the readable ones too."""
    opened: Opened = {name: attempt(raster.read, path) for name, path in maps.items()}
    good = [each for each in opened.values() if isinstance(each, raster.Raster)]
    if not good:
        reason = f"none of its {len(maps)} rasters can be read; {next(iter(opened.values()))}"
        raise input_error(next(iter(maps.values())).parent, reason)
    for each in good[1:]:
        if difference := each.difference(good[0]):
            raise input_error(each.path, f"{difference}; members need cells of one grid")
    return opened, good
