"""Rasters of members: a damaged one leaves its member out, and the others need cells of one grid."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from ....errors import InputError, input_error
from ....run.models import raster

Opened = dict[str, raster.Raster | InputError]


def open_members(maps: Mapping[str, Path], place: Path) -> tuple[Opened, list[raster.Raster]]:
    """Read the raster of each member: all of them, with the reason for damaged ones, and the readable ones.

    Raises
    ------
    InputError
        None can be read, or their cells differ.
    """
    opened: Opened = {name: _opened(path) for name, path in maps.items()}
    good = [each for each in opened.values() if isinstance(each, raster.Raster)]
    if not good:
        reason = f"none of its {len(maps)} rasters can be read; {next(iter(opened.values()))}"
        raise input_error(place, reason)
    for each in good[1:]:
        if not each.has_cells_of(good[0]):
            reason = f"has other cells than {good[0].path.name}; members need cells of one grid"
            raise input_error(each.path, reason)
    return opened, good


def _opened(path: Path) -> raster.Raster | InputError:
    try:
        return raster.read(path)
    except InputError as error:
        return error
