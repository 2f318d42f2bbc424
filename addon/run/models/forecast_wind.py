"""Wind at 10 m of a weather model (HRRR, GRIB2) for a run whose fire model writes none."""

from __future__ import annotations

from datetime import timedelta
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import input_error
from ..areas import metres_per_degree
from . import grib2
from .grib2 import GribField
from .grid import Grid
from .model import Model

_LEVEL = "10-HTGL"
_FIELDS = ("UGRD", "VGRD")


def add(model: Model, paths: list[Path]) -> None:
    """Add wind to a model: bilinear in space, linear in time between two valid times, constant outside.

    Raises
    ------
    InputError
        The model has wind, or the files have no wind at 10 m at its place and in its time.
    """
    if "wind_east" in model.moving:
        raise input_error(model.files[0], "already has wind; leave out --wind")
    east, north = _read(model, paths)
    grid = model.air or _air(model, east[0].side)
    latitude, longitude = grid.latitude, grid.longitude
    if latitude.ndim == 1:
        latitude, longitude = np.meshgrid(latitude, longitude, indexing="ij")
    seconds = np.array([(each.valid - model.start).total_seconds() for each in east])
    notes = _held(model, east, seconds)

    @lru_cache(2)  # both neighbours of a time
    def wind(index: int) -> tuple[NDArray, NDArray]:
        u, v = (each[index].at(latitude, longitude) for each in (east, north))
        return east[index].east_north(u, v, latitude, longitude)

    def along(axis: int, index: int) -> NDArray:
        time = float(model.times[index])
        before = int(np.clip(np.searchsorted(seconds, time, "right") - 1, 0, max(len(seconds) - 2, 0)))
        after = min(before + 1, len(seconds) - 1)
        part = (time - seconds[before]) / (seconds[after] - seconds[before]) if after > before else 0.0
        part = float(np.clip(part, 0.0, 1.0))
        return wind(before)[axis] * (1.0 - part) + wind(after)[axis] * part

    model.moving["wind_east"] = lambda index: along(0, index)
    model.moving["wind_north"] = lambda index: along(1, index)
    model.air = grid
    turned = "turned from the grid's axes to true north" if east[0].along_grid else "east and north as given"
    issued = ", ".join(sorted({f"{each.issued:%Y-%m-%d %H:%M}" for each in east}))
    model.assumptions.append(
        f"wind is UGRD and VGRD at 10 m of a weather forecast (issued {issued} UTC), {turned}; it did not "
        "drive the fire model"
    )
    model.assumptions += notes


def _read(model: Model, paths: list[Path]) -> tuple[list[GribField], list[GribField]]:
    """Read both components by valid time."""
    latitude, longitude = model.grid.latitude, model.grid.longitude
    if model.air is not None:
        latitude, longitude = model.air.latitude, model.air.longitude
    box = tuple(float(each) for each in (latitude.min(), longitude.min(), latitude.max(), longitude.max()))
    fields = grib2.read(paths, _FIELDS, {_LEVEL}, box)  # type: ignore[arg-type]
    east, north = ([each for each in fields if each.element == name] for name in _FIELDS)
    if not east or [each.valid for each in east] != [each.valid for each in north]:
        raise input_error(
            paths[0], "has no pair of UGRD and VGRD at 10 m above ground; give wrfsfc files of HRRR"
        )
    for each in fields:
        if each.unit != "m/s" or not np.isfinite(each.values).all():
            raise input_error(
                each.path, f"has {each.element} in {each.unit or 'no unit'}, or gaps; m/s are expected"
            )
    return east, north


def _held(model: Model, fields: list[GribField], seconds: NDArray[np.float64]) -> list[str]:
    """Describe the times of the run before and after all valid times, which have the first or last wind.

    Raises
    ------
    InputError
        No valid time is within the run.
    """
    first, last = float(model.times[0]), float(model.times[-1])
    have = " to ".join(f"{each.valid:%Y-%m-%d %H:%M}" for each in (fields[0], fields[-1]))
    if last < seconds[0] or first > seconds[-1]:
        need = [f"{model.start + timedelta(seconds=time):%Y-%m-%d %H:%M}" for time in (first, last)]
        reason = f"wind is valid at {have} UTC, and the run lasts from {need[0]} to {need[1]}"
        raise input_error(fields[0].path, f"{reason}; give files of its hours")
    outside = int(((model.times < seconds[0] - 1.0) | (model.times > seconds[-1] + 1.0)).sum())
    if not outside:
        return []
    return [
        f"wind is valid at {have} UTC: {outside} of {len(model.times)} times have its first or last value"
    ]


def _air(model: Model, side: float) -> Grid:
    """Create a grid of cells as large as the forecast's, which covers the run."""
    axes = []
    degree = metres_per_degree(float(np.mean(model.grid.latitude)))
    for values, metres in zip((model.grid.latitude, model.grid.longitude), degree, strict=True):
        low, high = float(values.min()) - 0.5 * side / metres, float(values.max()) + 0.5 * side / metres
        axes.append(np.linspace(low, high, max(2, int(np.ceil((high - low) * metres / side)) + 1)))
    return Grid(axes[0], axes[1])
