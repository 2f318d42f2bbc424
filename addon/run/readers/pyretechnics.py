"""Reader of pyretechnics: its matrices as saved by ``numpy.savez``.

``numpy.savez(path, **result["spread_state"].get_full_matrices(), cell_width=30, cell_height=30)``: rows from
the south, minutes, kW/m and m/min (pyretechnics, eulerian_level_set.py). `latitude` and `longitude` (degrees)
of rows and columns georeference it, or `x` and `y` with ``--projection``. Wind arrays have the names of its
cubes: `wind_speed_10m` (km/h) and `upwind_direction` (degrees), each one number, one for each band, or
(bands, rows, columns), with `band_duration` (minutes).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ... import unpacking
from ...errors import input_error
from ..models import companion_rasters, from_arrival_time, given_wind, one_run
from ..models.given_wind import Wind
from ..models.grid import Grid
from ..models.model import Model, Options
from ..models.raster import local

NAME, ORDER = "arrays of pyretechnics", 60
MODELS = "pyretechnics"


def sniff(path: Path) -> bool:
    """Check whether a file is an array archive with a time of arrival."""
    return unpacking.has_member(path, ["time_of_arrival.npy"])


def resembles(path: Path) -> bool:
    """Check whether a file has the suffix of array archives."""
    return path.suffix.lower() == ".npz" and path.is_file()


def why(paths: list[Path]) -> str:
    """Say what an archive needs."""
    said = "has no array time_of_arrival, by which pyretechnics' output is known"
    return said if resembles(paths[0]) else ""


def read(paths: list[Path], options: Options) -> Model:
    """Read the arrays as a model."""
    path = one_run.of_one([path for path in paths if sniff(path)])
    arrays = _arrays(path)
    minutes = arrays["time_of_arrival"]
    if minutes.ndim != 2:
        raise input_error(path, f"time_of_arrival has shape {minutes.shape}, not rows and columns")
    notes = [
        "times are in minutes, fireline_intensity in kW/m, spread_rate in m/min; rows are from the south"
    ]
    burned = np.isfinite(minutes) & (minutes >= 0)
    maps = from_arrival_time.Maps(np.where(burned, minutes * 60.0, np.nan))
    for name, field, unit in (("fireline_intensity", "intensity", 1e3), ("spread_rate", "speed", 1 / 60.0)):
        if name in arrays:
            setattr(maps, field, np.where(burned & (arrays[name] > 0), arrays[name] * unit, np.nan))
    for name in ("surface_fuel", "canopy_fuel", "elevation", "fuel_category"):
        if name in arrays:
            setattr(maps, name.removesuffix("_fuel").removeprefix("fuel_"), arrays[name])
    maps.wind = _wind(path, arrays, notes)
    grid = _grid(path, arrays, options, notes)
    return from_arrival_time.model(
        maps, grid, companion_rasters.find(paths, look=True), options, "pyretechnics", [path], notes
    )


def _wind(path: Path, arrays: dict[str, NDArray], notes: list[str]) -> Wind | None:
    """Read the wind from the cubes, constant within each band; rows are from the south, so y is north."""
    if not {"wind_speed_10m", "upwind_direction"} <= set(arrays):
        notes.append("no wind data (wind_speed_10m and upwind_direction): the air is calm")
        return None
    speed, source = (_bands(path, arrays, name) for name in ("wind_speed_10m", "upwind_direction"))
    try:
        speed, source = np.broadcast_arrays(speed / 3.6, np.radians(source))
        np.broadcast_to(speed[:1], (1, *arrays["time_of_arrival"].shape))
    except ValueError:
        reason = (
            f"has wind_speed_10m {speed.shape}, upwind_direction {source.shape}: not of its bands and cells"
        )
        raise input_error(path, reason) from None
    lasts = float(arrays["band_duration"].ravel()[0]) * 60.0 if "band_duration" in arrays else 0.0
    if len(speed) > 1 and not 0.0 < lasts < np.inf:
        raise input_error(path, "has wind for several bands; add band_duration (minutes)")
    notes.append("wind is wind_speed_10m (km/h) from upwind_direction, degrees clockwise from north")
    return given_wind.steps(-speed * np.sin(source), -speed * np.cos(source), 0.0, lasts)


def _bands(path: Path, arrays: dict[str, NDArray], name: str) -> NDArray:
    """Reshape an array to (bands, rows, columns), each possibly of length 1."""
    values = arrays[name]
    if values.ndim not in (0, 1, 3) or not np.isfinite(values).all() or values.size == 0:
        raise input_error(path, f"{name} has shape {values.shape}, not (bands, rows, columns), or gaps")
    return values.reshape(-1, 1, 1) if values.ndim < 3 else values


def _grid(path: Path, arrays: dict[str, NDArray], options: Options, notes: list[str]) -> Grid:
    ny, nx = arrays["time_of_arrival"].shape
    if {"latitude", "longitude"} <= set(arrays):
        return Grid(arrays["latitude"], arrays["longitude"])
    if {"x", "y"} <= set(arrays) and options.projection:
        return Grid.projected(arrays["x"], arrays["y"], options.projection)
    if {"cell_width", "cell_height"} <= set(arrays):
        width, height = (float(arrays[name].ravel()[0]) for name in ("cell_width", "cell_height"))
        grid, said = local(width * np.arange(nx), height * np.arange(ny), options.at)
        notes.append(said)
        return grid
    reason = (
        "has neither latitude and longitude nor cell_width and cell_height (m); add them with numpy.savez"
    )
    raise input_error(path, reason)


def _arrays(path: Path) -> dict[str, NDArray]:
    wanted: tuple[str, ...] = (
        "time_of_arrival",
        "fireline_intensity",
        "spread_rate",
        "surface_fuel",
        "canopy_fuel",
        "elevation",
        "fuel_category",
    )
    wanted += ("latitude", "longitude", "x", "y", "cell_width", "cell_height")
    wanted += ("wind_speed_10m", "upwind_direction", "band_duration")
    return unpacking.read_npz(path, wanted, np.float64)
